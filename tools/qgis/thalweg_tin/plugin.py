"""Adds the provider to Processing, with or without a window."""

from qgis.core import QgsApplication

from .provider import ThalwegProvider


class ThalwegPlugin:
    """Owned by QGIS; `iface` is None under qgis_process."""

    def __init__(self, iface):
        self.iface = iface
        self.provider = None

    def initProcessing(self):  # noqa: N802
        """Called by qgis_process, and by initGui."""
        self.provider = ThalwegProvider()
        QgsApplication.processingRegistry().addProvider(self.provider)

    def initGui(self):  # noqa: N802
        """Called by QGIS when the plugin is switched on."""
        self.initProcessing()

    def unload(self):
        """Called by QGIS when the plugin is switched off."""
        if self.provider is not None:
            QgsApplication.processingRegistry().removeProvider(self.provider)
            self.provider = None
