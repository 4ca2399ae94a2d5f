"""Simplify DEM."""

from qgis.core import (QgsProcessing, QgsProcessingException, QgsProcessingParameterFileDestination,
                       QgsProcessingParameterMapLayer, QgsProcessingParameterMultipleLayers,
                       QgsProcessingParameterNumber, QgsProcessingParameterString)

from .algorithm import MESHES, ThalwegAlgorithm
from .program import run


class SimplifyDem(ThalwegAlgorithm):
    """A TIN of few points that stays near a DEM."""

    NAME = "simplify"
    TITLE = "Simplify DEM"
    GROUP = "TIN"
    KEYWORDS = ["tin", "terrain", "mesh", "dem", "thin", "generalise", "decimate"]
    HELP = """Builds a TIN of few points of a DEM, or of a dense layer of points: none of the others is vertically
farther from it than the largest error. The bound holds for the final TIN, whose diagonals are chosen for fewest pits and
the smoothest surface among those that keep it. Valley and ridge lines stay, vertex by vertex.

With a number of points as well, the limit that is reached first stops; the report says which."""

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMapLayer(
            "INPUT", "DEM or elevation points", types=[QgsProcessing.TypeRaster, QgsProcessing.TypeVectorPoint]))
        self.addParameter(QgsProcessingParameterNumber("MAX_ERROR", "Largest error (metres)",
                                                       QgsProcessingParameterNumber.Double, defaultValue=1, optional=True,
                                                       minValue=0))
        self.addParameter(QgsProcessingParameterNumber("MAX_POINTS", "Largest number of points", optional=True,
                                                       minValue=3))
        for name, label in (("VALLEYS", "Valley lines"), ("RIDGES", "Ridge lines"), ("BREAKLINES", "Other breaklines")):
            self.addParameter(QgsProcessingParameterMultipleLayers(name, label, QgsProcessing.TypeVectorLine,
                                                                   optional=True))
        self.advanced(QgsProcessingParameterString("OPTIMIZE", "Criteria, in order of priority (none: Delaunay)",
                                                   defaultValue="local-minima,normal-angle-sum"))
        self.addParameter(QgsProcessingParameterFileDestination("OUTPUT", "Simplified TIN", MESHES))
        self.add_report()

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        layer = self.parameterAsLayer(parameters, "INPUT", context)
        if layer is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, "INPUT"))
        output = self.parameterAsFileOutput(parameters, "OUTPUT", context)
        arguments = ["build", self.source(layer, context, feedback), output, "--overwrite", "--progress"]
        criteria = self.parameterAsString(parameters, "OPTIMIZE", context)
        if criteria:
            arguments += ["--optimize", criteria]
        limits = []
        if parameters.get("MAX_ERROR") is not None:
            limits += ["--max-error", repr(self.parameterAsDouble(parameters, "MAX_ERROR", context))]
        if parameters.get("MAX_POINTS") is not None:
            limits += ["--max-points", str(self.parameterAsInt(parameters, "MAX_POINTS", context))]
        if not limits:
            raise QgsProcessingException("Give the largest error, or the largest number of points, or both")
        arguments += limits
        for name, option in (("VALLEYS", "--valleys"), ("RIDGES", "--ridges"), ("BREAKLINES", "--breaklines")):
            for lines in self.parameterAsLayerList(parameters, name, context) or []:
                arguments += [option, self.source(lines, context, feedback)]
        results = {"OUTPUT": output}
        arguments += self.report_arguments(parameters, context, results)
        run(arguments, feedback)
        self.load_mesh(output, "Simplified TIN", "OUTPUT", context)
        return results
