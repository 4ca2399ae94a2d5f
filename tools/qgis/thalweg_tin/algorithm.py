"""What the algorithms share: names, help, sources as the program takes them, outputs as layers."""

import re

from qgis.core import (QgsProcessingAlgorithm, QgsProcessingContext, QgsProcessingException,
                       QgsProcessingParameterDefinition, QgsProcessingParameterFileDestination, QgsProcessingUtils,
                       QgsVectorLayer)

from .style import LayerStyle

# The first is the default: QGIS colours a UGRID mesh by its heights, but no PLY that holds constraint edges.
MESHES = ("UGRID mesh (*.nc);;PLY mesh (*.ply);;SMS mesh (*.2dm);;LandXML surface (*.xml);;VTK grid (*.vtu);;"
          "Wavefront object (*.obj);;Object file format (*.off);;Stereolithography (*.stl);;glTF binary (*.glb)")
_FORMATS = ["gpkg", "shp", "geojson", "fgb"]


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
        another CRS in QGIS."""
        if not isinstance(layer, QgsVectorLayer):
            return layer.source()
        path, name = QgsProcessingUtils.convertToCompatibleFormatAndLayerName(
            layer, False, "source", _FORMATS if layer.crs() == layer.dataProvider().crs() else [], "gpkg", context, feedback)
        return f"{path}|layername={name}" if name else path

    def mesh_path(self, parameters, name, context):
        """The file of a mesh layer."""
        layer = self.parameterAsMeshLayer(parameters, name, context)
        if layer is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, name))
        inside = re.match(r'^[A-Za-z0-9_]+:"(.+?)"', layer.source())
        return inside.group(1) if inside else layer.source()

    def load_mesh(self, path, name, output, context):
        """Asks for the mesh to be loaded when the algorithm is done."""
        if context.project() is None:
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
