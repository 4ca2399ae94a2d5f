"""Thalweg TIN: Processing algorithms around the command line thalweg."""


def classFactory(iface):  # noqa: N802, the name that QGIS calls
    """The plugin, as QGIS asks for it."""
    from .plugin import ThalwegPlugin
    return ThalwegPlugin(iface)
