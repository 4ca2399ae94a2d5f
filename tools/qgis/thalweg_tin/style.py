"""How outputs look when QGIS loads them: the mesh with its triangles, lines by kind, pits, conflicts, flow."""

from qgis.core import (QgsFillSymbol, QgsLineSymbol, QgsMapLayer, QgsMarkerSymbol, QgsProcessingLayerPostProcessorInterface,
                       QgsRuleBasedRenderer, QgsSingleSymbolRenderer)

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
    "inconsistencies": lambda: _marker("cross_fill", "#e02020", 3),
}


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
            settings = layer.rendererSettings()
            native = settings.nativeMeshSettings()
            native.setEnabled(True)
            settings.setNativeMeshSettings(native)
            layer.setRendererSettings(settings)
        elif self.name in RENDERERS:
            layer.setRenderer(RENDERERS[self.name]())
        layer.triggerRepaint()
