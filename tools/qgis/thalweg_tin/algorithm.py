"""What the algorithms share: names, help, sources as the program takes them, outputs as layers."""

import contextlib
import os
import re
import shutil

from osgeo import gdal
from qgis.core import (QgsCoordinateReferenceSystem, QgsProcessingAlgorithm, QgsProcessingContext,
                       QgsProcessingException, QgsProcessingParameterDefinition,
                       QgsProcessingParameterFileDestination, QgsProcessingUtils, QgsRasterLayer, QgsVectorLayer)

from .style import LayerStyle

# The first is the default: QGIS colours a UGRID mesh by its heights, but no PLY that holds constraint edges.
MESHES = ("UGRID mesh (*.nc);;PLY mesh (*.ply);;SMS mesh (*.2dm);;LandXML surface (*.xml);;VTK grid (*.vtu);;"
          "Wavefront object (*.obj);;Object file format (*.off);;Stereolithography (*.stl);;glTF binary (*.glb)")
_LOADED = (".nc", ".ply", ".2dm")  # what QGIS reads of these
_FORMATS = ["gpkg", "shp", "geojson", "fgb"]
_AUTHORITIES = ("EPSG", "ESRI", "IAU_2015", "IGNF", "NKG", "OGC")  # of PROJ's database; QGIS adds USER and others


def crs_text(crs):
    """A CRS as the program takes it."""
    known = crs.authid().split(":")[0] in _AUTHORITIES
    return crs.authid() if known else crs.toWkt(QgsCoordinateReferenceSystem.WKT_PREFERRED)


def _mesh_file(layer):
    inside = re.match(r'^[A-Za-z0-9_]+:"(.+?)"', layer.source())
    return inside.group(1) if inside else layer.source()


def _told_crs(layer):
    """The CRS that the file of a mesh layer tells; QGIS does not look for that of a 2DM mesh, a .prj beside it."""
    prj = os.path.splitext(_mesh_file(layer))[0] + ".prj"
    if not _mesh_file(layer).lower().endswith(".2dm") or not os.path.isfile(prj):
        return layer.dataProvider().crs()
    with open(prj, encoding="utf-8", errors="replace") as text:
        return QgsCoordinateReferenceSystem(text.read().strip())


def _has_other_crs(layer, told):
    return layer.crs().isValid() and layer.crs() != told


class ThalwegAlgorithm(QgsProcessingAlgorithm):
    """A subclass sets NAME, TITLE, GROUP, HELP and KEYWORDS."""

    NAME = TITLE = GROUP = HELP = ""
    KEYWORDS = ["tin", "terrain", "mesh"]

    def name(self):
        return self.NAME

    def displayName(self):  # noqa: N802
        return self.TITLE

    def group(self):
        return self.GROUP

    def groupId(self):  # noqa: N802
        return self.GROUP.lower()

    def shortHelpString(self):  # noqa: N802
        return self.HELP

    def tags(self):
        return self.KEYWORDS

    def createInstance(self):  # noqa: N802
        return type(self)()

    def add_report(self):
        """The parameter REPORT, which is made only where it is asked for."""
        self.addParameter(QgsProcessingParameterFileDestination("REPORT", "Report", "JSON (*.json)", optional=True,
                                                                createByDefault=False))

    def report_arguments(self, parameters, context, results):
        """What the program has to be told for REPORT; its path goes into the results."""
        report = self.parameterAsFileOutput(parameters, "REPORT", context) if parameters.get("REPORT") else ""
        if not report:
            return []
        results["REPORT"] = report
        return ["--report", report]

    def advanced(self, parameter):
        """Adds a parameter that is folded away."""
        parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
        self.addParameter(parameter)

    def source(self, layer, context, feedback):
        """A layer as a source of the program: PATH or PATH|layername=NAME; exported where it is no file, or has got
        another CRS in QGIS: a raster as a VRT, which refers to it."""
        if isinstance(layer, QgsRasterLayer) and _has_other_crs(layer, layer.dataProvider().crs()):
            path = QgsProcessingUtils.generateTempFilename("source.vrt")
            with contextlib.suppress(RuntimeError):  # or there is just no file, as GDAL is set
                gdal.Translate(path, layer.source(), format="VRT", outputSRS=crs_text(layer.crs()))
            if not os.path.isfile(path):
                raise QgsProcessingException(f"{layer.source()} cannot be given the CRS of the layer {layer.name()}: "
                                             f"{gdal.GetLastErrorMsg()}; save the layer as GeoTIFF.")
            return path
        if not isinstance(layer, QgsVectorLayer):
            return layer.source()
        path, name = QgsProcessingUtils.convertToCompatibleFormatAndLayerName(
            layer, False, "source", _FORMATS if layer.crs() == layer.dataProvider().crs() else [], "gpkg", context, feedback)
        return f"{path}|layername={name}" if name else path

    def mesh_path(self, parameters, name, context, output=""):
        """The file of a mesh layer, which must not be the output; of a 2DM mesh that has got another CRS in QGIS, a
        copy that tells it."""
        layer = self.parameterAsMeshLayer(parameters, name, context)
        if layer is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, name))
        path, told = _mesh_file(layer), _told_crs(layer)
        if path == output:
            raise QgsProcessingException("The output is the input; give it another name.")
        if not _has_other_crs(layer, told):
            return path
        if not path.lower().endswith(".2dm"):
            raise QgsProcessingException(
                f"The layer {layer.name()} has the CRS {layer.crs().userFriendlyIdentifier()} in QGIS, but "
                f"{told.userFriendlyIdentifier() if told.isValid() else 'none'} in its file {path}, which counts. Set the "
                "layer's CRS to that of the file; for another, build the TIN from points in it.")
        copy = QgsProcessingUtils.generateTempFilename("mesh.2dm")
        shutil.copyfile(path, copy)
        with open(os.path.splitext(copy)[0] + ".prj", "w", encoding="utf-8") as prj:
            prj.write(layer.crs().toWkt(QgsCoordinateReferenceSystem.WKT_PREFERRED))
        return copy

    def mesh_crs(self, parameters, name, context):
        """The CRS of what mesh_path gives."""
        layer = self.parameterAsMeshLayer(parameters, name, context)
        return layer.crs() if layer.crs().isValid() else _told_crs(layer)

    def load_mesh(self, path, name, output, context):
        """Asks for the mesh to be loaded when the algorithm is done, where QGIS reads its format."""
        if context.project() is None or not path.lower().endswith(_LOADED):
            return
        details = QgsProcessingContext.LayerDetails(name, context.project(), output,
                                                    QgsProcessingUtils.LayerHint.Mesh)
        details.setPostProcessor(LayerStyle())
        context.addLayerToLoadOnCompletion(path, details)

    def load_layers(self, path, names, output, context):
        """Asks for layers of a GeoPackage to be loaded; the last is on top. A TIN's pits are some of its vertices."""
        if context.project() is None:
            return
        for name in names:
            of_vertices = name == "tin_pits"
            uri = f"{path}|layername=vertices|subset=\"is_pit\" = 1" if of_vertices else f"{path}|layername={name}"
            kind = "pits" if of_vertices else name
            details = QgsProcessingContext.LayerDetails(kind.replace("_", " ").capitalize(), context.project(), output,
                                                        QgsProcessingUtils.LayerHint.Vector)
            details.forceName = True  # all have the file's else
            details.setPostProcessor(LayerStyle(kind))
            context.addLayerToLoadOnCompletion(uri, details)

    def load_tin_layers(self, path, output, context, with_conflicts):
        """Those layers of a TIN that a map wants; conflicts are known of one that was just built."""
        names = ("breaklines", "conflicts", "tin_pits") if with_conflicts else ("breaklines", "tin_pits")
        self.load_layers(path, names, output, context)
