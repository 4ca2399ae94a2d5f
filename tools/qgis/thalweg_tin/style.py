"""How outputs look when QGIS loads them: the mesh by height with its triangles, lines by kind, pits, conflicts, flow."""

from qgis.core import (QgsColorRampShader, QgsFillSymbol, QgsGradientColorRamp, QgsGradientStop, QgsLineSymbol, QgsMapLayer,
                       QgsMarkerSymbol, QgsMeshDatasetIndex, QgsProcessingLayerPostProcessorInterface,
                       QgsRuleBasedRenderer, QgsSingleSymbolRenderer)
from qgis.PyQt.QtGui import QColor

# An edge can be of several kinds; the first that it is says how it is drawn.
_KINDS = [("valley", "Valleys", "#1f6fd0", 0.7), ("ridge", "Ridges", "#8a4b08", 0.7), ("lake", "Lakes", "#17a2b8", 0.6),
          ("hole", "Holes", "#606060", 0.5), ("boundary", "Boundary", "#202020", 0.5),
          ("breakline", "Breaklines", "#c02020", 0.5)]


def _lines_by_kind():
    root = QgsRuleBasedRenderer.Rule(None)
    before = []
    for kind, label, color, width in _KINDS:
        is_kind = f"\"kind\" LIKE '%{kind}%'"
        condition = " AND ".join([is_kind, *(f"NOT {other}" for other in before)])
        symbol = QgsLineSymbol.createSimple({"color": color, "width": str(width)})
        root.appendChild(QgsRuleBasedRenderer.Rule(symbol, 0, 0, condition, label))
        before.append(is_kind)
    return QgsRuleBasedRenderer(root)


def _marker(name, color, size):
    return QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(
        {"name": name, "color": color, "outline_color": "#ffffff", "outline_width": "0.2", "size": str(size)}))


def _line(color, width):
    return QgsSingleSymbolRenderer(QgsLineSymbol.createSimple({"color": color, "width": str(width)}))


def _outline(color):
    return QgsSingleSymbolRenderer(QgsFillSymbol.createSimple(
        {"style": "no", "outline_color": color, "outline_width": "0.3"}))


RENDERERS = {
    "breaklines": _lines_by_kind,
    "pits": lambda: _marker("circle", "#0040ff", 2.6),
    "conflicts": lambda: _marker("triangle", "#e02080", 2.8),
    "flow_paths": lambda: _line("#5aa9e6", 0.3),
    "network": lambda: _line("#1f6fd0", 0.6),
    "catchments": lambda: _outline("#7a3fa0"),
    "inconsistencies": lambda: _line("#e02020", 1),
}


# From valleys to summits.
_HEIGHTS = [(0, "#5b8c5a"), (0.3, "#b9cc8f"), (0.55, "#e8dba8"), (0.8, "#b8936a"), (1, "#f4f0ea")]


def _style_mesh(layer):
    """Heights as colours, triangles as thin lines. QGIS draws no colours where a mesh has edges of its own."""
    colours = layer.meshEdgeCount() == 0
    settings = layer.rendererSettings()
    native = settings.nativeMeshSettings()
    native.setEnabled(True)
    native.setColor(QColor(60, 60, 60, 110 if colours else 255))
    native.setLineWidth(0.12)
    settings.setNativeMeshSettings(native)
    for group in layer.datasetGroupsIndexes() if colours else []:
        of_group = layer.datasetGroupMetadata(QgsMeshDatasetIndex(group, 0))
        if of_group.name() != "Bed Elevation" or not of_group.minimum() < of_group.maximum():
            continue
        stops = [QgsGradientStop(at, QColor(color)) for at, color in _HEIGHTS[1:-1]]
        ramp = QgsGradientColorRamp(QColor(_HEIGHTS[0][1]), QColor(_HEIGHTS[-1][1]), False, stops)
        shader = QgsColorRampShader(of_group.minimum(), of_group.maximum(), ramp, QgsColorRampShader.Interpolated)
        shader.classifyColorRamp(len(_HEIGHTS) * 4, -1)
        scalar = settings.scalarSettings(group)
        scalar.setColorRampShader(shader)
        scalar.setClassificationMinimumMaximum(of_group.minimum(), of_group.maximum())
        settings.setScalarSettings(group, scalar)
        settings.setActiveScalarDatasetGroup(group)
        break
    layer.setRendererSettings(settings)


class LayerStyle(QgsProcessingLayerPostProcessorInterface):
    """Styles one layer once it is loaded."""

    kept = []  # QGIS does not keep them alive

    def __init__(self, name=""):
        super().__init__()
        self.name = name
        LayerStyle.kept.append(self)

    def postProcessLayer(self, layer, context, feedback):  # noqa: N802
        if layer is None:
            return
        if layer.type() == QgsMapLayer.MeshLayer:
            _style_mesh(layer)
        elif self.name in RENDERERS:
            layer.setRenderer(RENDERERS[self.name]())
        layer.triggerRepaint()
