"""Profiles along lines, and volumes."""

import json

from qgis.core import (QgsProcessing, QgsProcessingContext, QgsProcessingException, QgsProcessingOutputNumber,
                       QgsProcessingParameterFileDestination, QgsProcessingParameterMapLayer,
                       QgsProcessingParameterMeshLayer, QgsProcessingParameterNumber, QgsProcessingUtils)

from .algorithm import ThalwegAlgorithm
from .program import run


class Profile(ThalwegAlgorithm):
    """Heights along lines."""

    NAME = "profile"
    TITLE = "Profile along lines"
    GROUP = "Measure"
    KEYWORDS = ["tin", "profile", "section", "cross-section", "heights", "lines"]
    HELP = """A table of heights along lines: a row wherever a line starts, ends, bends or crosses an edge of the TIN, so that
between rows the surface is straight. Columns: line, part (a line that leaves the TIN has several), distance from the
line's start in metres, x, y, z."""

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMeshLayer("INPUT", "TIN"))
        self.addParameter(QgsProcessingParameterMapLayer("LINES", "Lines", types=[QgsProcessing.TypeVectorLine]))
        self.addParameter(QgsProcessingParameterFileDestination("OUTPUT", "Table", "Comma separated values (*.csv)"))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        output = self.parameterAsFileOutput(parameters, "OUTPUT", context)
        lines = self.parameterAsLayer(parameters, "LINES", context)
        if lines is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, "LINES"))
        run(["convert", self.mesh_path(parameters, "INPUT", context), output, "--overwrite", "--progress", "--profile",
             self.source(lines, context, feedback)], feedback)
        if context.project() is not None:
            context.addLayerToLoadOnCompletion(output, QgsProcessingContext.LayerDetails(
                "Profile", context.project(), "OUTPUT", QgsProcessingUtils.LayerHint.Vector))
        return {"OUTPUT": output}


class Volume(ThalwegAlgorithm):
    """Cut and fill."""

    NAME = "volume"
    TITLE = "Volume above a height or another TIN"
    GROUP = "Measure"
    KEYWORDS = ["tin", "volume", "cut", "fill", "earthwork", "storage"]
    HELP = """The volume between the TIN and a level plane, or another TIN of the same CRS where both are: what lies above the
reference, what is missing below it, and the areas. Exact for the two surfaces: no cells. Cubic and square metres."""
    _RESULTS = (("ABOVE", "above_m3", "Volume above (m3)"), ("BELOW", "below_m3", "Volume below (m3)"),
                ("NET", "net_m3", "Net volume (m3)"), ("AREA_ABOVE", "area_above_m2", "Area above (m2)"),
                ("AREA_BELOW", "area_below_m2", "Area below (m2)"), ("AREA", "area_m2", "Area of both (m2)"))

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMeshLayer("INPUT", "TIN"))
        self.addParameter(QgsProcessingParameterNumber("HEIGHT", "Height of a level plane, in the TIN's unit of heights",
                                                       QgsProcessingParameterNumber.Double, optional=True))
        self.addParameter(QgsProcessingParameterMeshLayer("REFERENCE", "Or another TIN", optional=True))
        for name, _, label in self._RESULTS:
            self.addOutput(QgsProcessingOutputNumber(name, label))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        above, between = parameters.get("HEIGHT") is not None, bool(parameters.get("REFERENCE"))
        if above == between:
            raise QgsProcessingException("Give a height, or another TIN, and not both.")
        reference = (["--volume-between", self.mesh_path(parameters, "REFERENCE", context)] if between else
                     [f"--volume-above={self.parameterAsDouble(parameters, 'HEIGHT', context)!r}"])
        told = run(["info", self.mesh_path(parameters, "INPUT", context), "--progress", "-f", "json", *reference],
                   feedback)
        volume = json.loads(told)["volumes"][0]
        return {name: volume[key] for name, key, _ in self._RESULTS}
