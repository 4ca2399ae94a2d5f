"""TIN to raster, contours, vector layers and other meshes."""

from qgis.core import (QgsProcessing, QgsProcessingParameterEnum, QgsProcessingParameterExtent,
                       QgsProcessingParameterFileDestination, QgsProcessingParameterMeshLayer,
                       QgsProcessingParameterNumber, QgsProcessingParameterRasterDestination,
                       QgsProcessingParameterString, QgsProcessingParameterVectorDestination)

from .algorithm import MESHES, ThalwegAlgorithm
from .program import run

SURFACES = ["elevation", "hillshade", "slope", "aspect"]


class TinToRaster(ThalwegAlgorithm):
    """Heights, hillshade, slope or aspect."""

    NAME = "tintoraster"
    TITLE = "TIN to raster"
    GROUP = "Convert"
    KEYWORDS = ["tin", "dem", "raster", "hillshade", "slope", "aspect", "interpolation"]
    HELP = """A raster of the TIN: linear in each triangle, exact at vertices, no data outside. Without an extent the
cell centres start at the lowest x and highest y of the TIN, so that a DEM comes back cell by cell."""

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMeshLayer("INPUT", "TIN"))
        self.addParameter(QgsProcessingParameterEnum("SURFACE", "Surface", SURFACES, defaultValue=0))
        self.addParameter(QgsProcessingParameterNumber("RESOLUTION", "Side of a cell, in units of the TIN",
                                                       QgsProcessingParameterNumber.Double, defaultValue=1,
                                                       minValue=1e-12))
        self.addParameter(QgsProcessingParameterExtent("EXTENT", "Extent", optional=True))
        self.addParameter(QgsProcessingParameterRasterDestination("OUTPUT", "Raster"))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        output = self.parameterAsOutputLayer(parameters, "OUTPUT", context)
        arguments = ["convert", self.mesh_path(parameters, "INPUT", context), output, "--overwrite", "--progress",
                     "--surface", SURFACES[self.parameterAsEnum(parameters, "SURFACE", context)],
                     "--resolution", repr(self.parameterAsDouble(parameters, "RESOLUTION", context))]
        if parameters.get("EXTENT"):
            box = self.parameterAsExtent(parameters, "EXTENT", context, self.mesh_crs(parameters, "INPUT", context))
            sides = (box.xMinimum(), box.yMinimum(), box.xMaximum(), box.yMaximum())
            arguments.append("--extent=" + ",".join(map(repr, sides)))
        run(arguments, feedback)
        return {"OUTPUT": output}


class TinToContours(ThalwegAlgorithm):
    """Contour lines."""

    NAME = "contours"
    TITLE = "Contours of a TIN"
    GROUP = "Convert"
    KEYWORDS = ["tin", "contours", "isolines"]
    HELP = """Lines of equal height, with z and the height as attribute: closed or ending on the rim, uphill to the
right, none twice; a plateau has its rim for a contour."""

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMeshLayer("INPUT", "TIN"))
        self.addParameter(QgsProcessingParameterNumber("INTERVAL", "Interval", QgsProcessingParameterNumber.Double,
                                                       defaultValue=10, minValue=1e-9))
        self.addParameter(QgsProcessingParameterNumber("BASE", "A height that is a contour's",
                                                       QgsProcessingParameterNumber.Double, defaultValue=0))
        self.addParameter(QgsProcessingParameterString("FIELD", "Field for the height", defaultValue="elev"))
        self.addParameter(QgsProcessingParameterVectorDestination("OUTPUT", "Contours",
                                                                  QgsProcessing.TypeVectorLine))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        output = self.parameterAsOutputLayer(parameters, "OUTPUT", context)
        field = self.parameterAsString(parameters, "FIELD", context)
        run(["convert", self.mesh_path(parameters, "INPUT", context), output, "--overwrite", "--progress", "--contours",
             "--interval", repr(self.parameterAsDouble(parameters, "INTERVAL", context)),
             f"--base={self.parameterAsDouble(parameters, 'BASE', context)!r}",
             *(["--field", field] if field not in ("", "elev") else [])], feedback)  # DXF has no fields
        return {"OUTPUT": output}


class TinToLayers(ThalwegAlgorithm):
    """Triangles, edges, vertices and breaklines in a GeoPackage."""

    NAME = "tintolayers"
    TITLE = "TIN to vector layers"
    GROUP = "Convert"
    HELP = """A GeoPackage with the layers triangles, edges (with their kind), vertices (is_pit marks pits) and
breaklines. Breaklines and pits are loaded."""

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMeshLayer("INPUT", "TIN"))
        self.addParameter(QgsProcessingParameterFileDestination("OUTPUT", "Layers", "GeoPackage (*.gpkg)"))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        output = self.parameterAsFileOutput(parameters, "OUTPUT", context)
        run(["convert", self.mesh_path(parameters, "INPUT", context), output, "--of", "GPKG", "--overwrite",
             "--progress"], feedback)
        self.load_tin_layers(output, "OUTPUT", context, with_conflicts=False)
        return {"OUTPUT": output}


class ExportTin(ThalwegAlgorithm):
    """Another mesh format."""

    NAME = "export"
    TITLE = "TIN to another mesh format"
    GROUP = "Convert"
    HELP = "Writes the TIN as UGRID, LandXML, VTU, OBJ, OFF, STL, glTF, 2DM or PLY; the file's extension says which."

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMeshLayer("INPUT", "TIN"))
        self.addParameter(QgsProcessingParameterFileDestination("OUTPUT", "Mesh", MESHES))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        output = self.parameterAsFileOutput(parameters, "OUTPUT", context)
        run(["convert", self.mesh_path(parameters, "INPUT", context, output), output, "--overwrite", "--progress"],
            feedback)
        self.load_mesh(output, "TIN", "OUTPUT", context)
        return {"OUTPUT": output}
