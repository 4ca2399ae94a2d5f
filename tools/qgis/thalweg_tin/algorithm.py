"""What the algorithms share: names, help, sources as the program takes them, outputs as layers."""

import re

from qgis.core import (QgsMapLayer, QgsProcessingAlgorithm, QgsProcessingContext, QgsProcessingException,
                       QgsProcessingLayerPostProcessorInterface, QgsProcessingParameterDefinition,
                       QgsProcessingUtils, QgsVectorLayer)

MESHES = ("PLY mesh (*.ply);;UGRID mesh (*.nc);;SMS mesh (*.2dm);;LandXML surface (*.xml);;VTK grid (*.vtu);;"
          "Wavefront object (*.obj);;Object file format (*.off);;Stereolithography (*.stl);;glTF binary (*.glb)")
_FORMATS = ["gpkg", "shp", "geojson", "fgb"]


class MeshStyle(QgsProcessingLayerPostProcessorInterface):
    """Shows the triangles of a mesh that was loaded."""

    kept = []  # QGIS does not keep them alive

    def postProcessLayer(self, layer, context, feedback):  # noqa: N802
        if layer is None or layer.type() != QgsMapLayer.MeshLayer:
            return
        settings = layer.rendererSettings()
        native = settings.nativeMeshSettings()
        native.setEnabled(True)
        settings.setNativeMeshSettings(native)
        layer.setRendererSettings(settings)
        layer.triggerRepaint()


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

    def advanced(self, parameter):
        """Adds a parameter that is folded away."""
        parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
        self.addParameter(parameter)

    def source(self, layer, context, feedback):
        """A layer as a source of the program: PATH or PATH|layername=NAME; exported where it is no file."""
        if not isinstance(layer, QgsVectorLayer):
            return layer.source()
        path, name = QgsProcessingUtils.convertToCompatibleFormatAndLayerName(
            layer, False, "source", _FORMATS, "gpkg", context, feedback)
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
        style = MeshStyle()
        MeshStyle.kept.append(style)
        details.setPostProcessor(style)
        context.addLayerToLoadOnCompletion(path, details)

    def load_layers(self, path, output, context):
        """Asks for the layers of a GeoPackage that a map wants to be loaded."""
        if context.project() is None:
            return
        for layer in ("breaklines", "conflicts", "vertices"):
            uri = f"{path}|layername={layer}"
            context.addLayerToLoadOnCompletion(uri, QgsProcessingContext.LayerDetails(
                f"TIN {layer}", context.project(), output, QgsProcessingUtils.LayerHint.Vector))
