"""The provider: its algorithms, its icon, and the setting that says where the program is."""

import os

from processing.core.ProcessingConfig import ProcessingConfig, Setting
from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from .build import BuildTin
from .convert import ExportTin, TinToContours, TinToLayers, TinToRaster
from .drain import DrainageReport
from .measure import Profile, Volume
from .optimize import OptimizeTin
from .orders import ConstrainedOrders
from .program import SETTING
from .simplify import SimplifyDem


class ThalwegProvider(QgsProcessingProvider):
    """Processing shows it as "Thalweg"."""

    def id(self):  # noqa: A003
        return "thalweg"

    def name(self):
        return "Thalweg"

    def longName(self):  # noqa: N802
        return "Thalweg terrain TINs"

    def icon(self):
        return QIcon(os.path.join(os.path.dirname(__file__), "icon.svg"))

    def supportsNonFileBasedOutput(self):  # noqa: N802
        """The program writes files, no layers in memory or in a database."""
        return False

    def load(self):
        ProcessingConfig.settingIcons["Thalweg"] = self.icon()
        ProcessingConfig.addSetting(Setting("Thalweg", SETTING, "Thalweg program", "", valuetype=Setting.FILE))
        ProcessingConfig.readSettings()
        self.refreshAlgorithms()
        return True

    def unload(self):
        ProcessingConfig.removeSetting(SETTING)

    def loadAlgorithms(self):  # noqa: N802
        for algorithm in (BuildTin, SimplifyDem, OptimizeTin, ConstrainedOrders, TinToRaster, TinToContours, TinToLayers,
                          ExportTin, DrainageReport, Profile, Volume):
            self.addAlgorithm(algorithm())
