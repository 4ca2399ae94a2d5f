"""Build TIN."""

import os

from qgis.core import (QgsProcessing, QgsProcessingException, QgsProcessingParameterCrs,
                       QgsProcessingParameterDistance, QgsProcessingParameterEnum, QgsProcessingParameterField,
                       QgsProcessingParameterFileDestination, QgsProcessingParameterMapLayer,
                       QgsProcessingParameterMultipleLayers, QgsProcessingParameterNumber,
                       QgsProcessingParameterString, QgsRasterLayer)

from .algorithm import MESHES, ThalwegAlgorithm, crs_text
from .program import run

DEFINITIONS = ["sees-opp", "std", "pathcon", "sees-triang", "sees-vtx", "conf-edge", "sees-3vtx", "empty-quad"]
CROSSINGS = ["auto", "error", "lower", "higher", "mean", "first", "last"]
DUPLICATES = ["first", "last", "lowest", "highest", "mean"]
NODATA = ["bridge-holes", "bridge-all", "bridge-none"]
METHODS = ["exact", "flip", "hull"]


class BuildTin(ThalwegAlgorithm):
    """Points or a DEM, and lines, to an optimised TIN."""

    NAME = "build"
    TITLE = "Build TIN"
    GROUP = "TIN"
    KEYWORDS = ["tin", "terrain", "delaunay", "breaklines", "ridge", "valley", "thalweg", "pits", "dem"]
    HELP = """Triangulates elevation points or the cells of a DEM, with ridge, valley and other lines as edges, and then
chooses the diagonal of every free quadrilateral: fewest pits first, then the smoothest surface. No height is touched.

Points take their heights from the geometry (PointZ) or from the field given. Lines with heights are kept as they are;
lines without take them from the surface. Where lines cross, touch or overlap, they are noded; heights that disagree are
in the layer of conflicts of the GeoPackage.

Layers in longitude and latitude are triangulated in metres and written back unchanged.
The report is JSON: counts, conflicts, each criterion with its value, its bound and whether it is proved best."""

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMapLayer(
            "INPUT", "Elevation points or DEM", types=[QgsProcessing.TypeVectorPoint, QgsProcessing.TypeRaster]))
        self.addParameter(QgsProcessingParameterField("Z_FIELD", "Field with the height of points", optional=True,
                                                      parentLayerParameterName="INPUT",
                                                      type=QgsProcessingParameterField.Numeric))
        for name, label in (("VALLEYS", "Valley lines"), ("RIDGES", "Ridge lines"), ("BREAKLINES", "Other breaklines")):
            self.addParameter(QgsProcessingParameterMultipleLayers(name, label, QgsProcessing.TypeVectorLine,
                                                                   optional=True))
        self.addParameter(QgsProcessingParameterMultipleLayers(
            "BOUNDARY", "Areas to keep", QgsProcessing.TypeVectorPolygon, optional=True))
        self.addParameter(QgsProcessingParameterMultipleLayers(
            "HOLES", "Areas to cut out", QgsProcessing.TypeVectorPolygon, optional=True))
        self.addParameter(QgsProcessingParameterMultipleLayers(
            "LAKES", "Lakes, flat at their z, else at the lowest height of the shore", QgsProcessing.TypeVectorPolygon,
            optional=True))
        self.addParameter(QgsProcessingParameterNumber(
            "ORDER", "Largest order of a triangle (0: constrained Delaunay)", defaultValue=1, minValue=0))
        self.addParameter(QgsProcessingParameterCrs("TARGET_CRS", "CRS of the TIN (default: that of the points)",
                                                    optional=True))
        self.advanced(QgsProcessingParameterString("LINE_Z_FIELD", "Field with the one height of a line", optional=True))
        self.advanced(QgsProcessingParameterString("KIND_FIELD", "Field that says ridge or valley", optional=True))
        self.advanced(QgsProcessingParameterString("OPTIMIZE", "Criteria, in order of priority (none: Delaunay)",
                                                   defaultValue="local-minima,normal-angle-sum"))
        self.advanced(QgsProcessingParameterEnum("DEFINITION", "Which constrained order", DEFINITIONS, defaultValue=0))
        self.advanced(QgsProcessingParameterEnum("METHOD", "How fewest pits are found: exactly, or by a published heuristic",
                                                 METHODS, defaultValue=0))
        self.advanced(QgsProcessingParameterEnum("CROSSING", "Height where lines cross", CROSSINGS, defaultValue=0))
        self.advanced(QgsProcessingParameterEnum("DUPLICATES", "Height of points at one place", DUPLICATES,
                                                 defaultValue=0))
        self.advanced(QgsProcessingParameterEnum("NODATA", "DEM regions without data", NODATA, defaultValue=0))
        self.advanced(QgsProcessingParameterNumber("SNAP", "Points nearer than this are one (metres)",
                                                   QgsProcessingParameterNumber.Double, defaultValue=0, minValue=0))
        self.advanced(QgsProcessingParameterNumber("MAX_EDGE", "Drop rim triangles with a longer rim edge (metres)",
                                                   QgsProcessingParameterNumber.Double, optional=True, minValue=0))
        self.addParameter(QgsProcessingParameterFileDestination("OUTPUT", "TIN", MESHES))
        self.addParameter(QgsProcessingParameterFileDestination(
            "LAYERS", "Triangles, edges, vertices, breaklines and conflicts", "GeoPackage (*.gpkg)", optional=True,
            createByDefault=False))
        self.add_report()
        self.addParameter(QgsProcessingParameterFileDestination(
            "PICTURE", "Picture", "PNG (*.png);;SVG (*.svg);;PDF (*.pdf)", optional=True, createByDefault=False))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        layer = self.parameterAsLayer(parameters, "INPUT", context)
        if layer is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, "INPUT"))
        output = self.parameterAsFileOutput(parameters, "OUTPUT", context)
        layers = self.parameterAsFileOutput(parameters, "LAYERS", context) if parameters.get("LAYERS") else ""
        arguments = ["build", self.source(layer, context, feedback), layers or output, "--overwrite", "--progress"]
        for name, option in (("VALLEYS", "--valleys"), ("RIDGES", "--ridges"), ("BREAKLINES", "--breaklines"),
                             ("BOUNDARY", "--boundary"), ("HOLES", "--holes"), ("LAKES", "--lakes")):
            for lines in self.parameterAsLayerList(parameters, name, context) or []:
                arguments += [option, self.source(lines, context, feedback)]
        fields = [("LINE_Z_FIELD", "--line-z-field"), ("KIND_FIELD", "--kind-field"), ("OPTIMIZE", "--optimize")]
        if not isinstance(layer, QgsRasterLayer):
            fields.append(("Z_FIELD", "--z-field"))
        for name, option in fields:
            value = self.parameterAsString(parameters, name, context)
            if value:
                arguments += [option, value]
        for name, option, words in (("DEFINITION", "--definition", DEFINITIONS), ("CROSSING", "--crossing", CROSSINGS),
                                    ("DUPLICATES", "--duplicates", DUPLICATES), ("NODATA", "--nodata", NODATA),
                                    ("METHOD", "--method", METHODS)):
            arguments += [option, words[self.parameterAsEnum(parameters, name, context)]]
        arguments += ["--order", str(self.parameterAsInt(parameters, "ORDER", context))]
        for name, option in (("SNAP", "--snap"), ("MAX_EDGE", "--max-edge")):
            if parameters.get(name) and self.parameterAsDouble(parameters, name, context) > 0:
                arguments += [option, repr(self.parameterAsDouble(parameters, name, context))]
        crs = self.parameterAsCrs(parameters, "TARGET_CRS", context)
        if crs.isValid():
            arguments += ["--t-crs", crs_text(crs)]
        results = {"OUTPUT": output}
        for name, option in (("REPORT", "--report"), ("PICTURE", "--picture")):
            path = self.parameterAsFileOutput(parameters, name, context) if parameters.get(name) else ""
            if path:
                arguments += [option, path]
                results[name] = path
        run(arguments, feedback)
        if layers:  # which alone hold the conflicts; the mesh is made from them
            try:
                run(["convert", layers, output, "--overwrite", "--progress"], feedback)
            except QgsProcessingException:
                if feedback.isCanceled():  # no output is left
                    for path in (layers, *(results[name] for name in ("REPORT", "PICTURE") if name in results)):
                        os.remove(path)
                raise
            results["LAYERS"] = layers
            self.load_tin_layers(layers, "LAYERS", context, with_conflicts=True)
        self.load_mesh(output, "TIN", "OUTPUT", context)
        return results
