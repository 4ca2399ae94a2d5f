"""Constrained orders."""

import json

from qgis.core import (QgsProcessing, QgsProcessingException, QgsProcessingOutputString, QgsProcessingParameterEnum,
                       QgsProcessingParameterFileDestination, QgsProcessingParameterMapLayer,
                       QgsProcessingParameterMultipleLayers, QgsProcessingParameterString)

from .algorithm import ThalwegAlgorithm
from .build import DEFINITIONS
from .program import run


class ConstrainedOrders(ThalwegAlgorithm):
    """Orders of a triangle, and the quadrilaterals whose diagonal is free."""

    NAME = "orders"
    TITLE = "Constrained orders"
    GROUP = "Analysis"
    HELP = """Lists, as CSV, the quadrilaterals of the constrained Delaunay triangulation whose other diagonal gives
triangles of order 1 under the definition chosen: s,u,t,v are point numbers, from 0 in the order of the layer, counter-
clockwise; delaunay says which diagonal the triangulation has. With a triangle A,B,C its orders under all eight
definitions are returned, too. Heights are not needed."""

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMapLayer(
            "INPUT", "Points or DEM", types=[QgsProcessing.TypeVectorPoint, QgsProcessing.TypeRaster]))
        self.addParameter(QgsProcessingParameterMultipleLayers("BREAKLINES", "Lines", QgsProcessing.TypeVectorLine,
                                                               optional=True))
        self.addParameter(QgsProcessingParameterEnum("DEFINITION", "Which constrained order", DEFINITIONS,
                                                     defaultValue=0))
        self.addParameter(QgsProcessingParameterString("TRIANGLE", "Orders of the triangle A,B,C", optional=True))
        self.addParameter(QgsProcessingParameterFileDestination("OUTPUT", "Quadrilaterals", "CSV (*.csv)"))
        self.addOutput(QgsProcessingOutputString("ORDERS", "Orders of the triangle, JSON"))

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        layer = self.parameterAsLayer(parameters, "INPUT", context)
        if layer is None:
            raise QgsProcessingException(self.invalidSourceError(parameters, "INPUT"))
        output = self.parameterAsFileOutput(parameters, "OUTPUT", context)
        arguments = ["order", self.source(layer, context, feedback), "--list-quadrilaterals", output, "--overwrite",
                     "-f", "json", "--progress",
                     "--definition", DEFINITIONS[self.parameterAsEnum(parameters, "DEFINITION", context)]]
        for lines in self.parameterAsLayerList(parameters, "BREAKLINES", context) or []:
            arguments += ["--breaklines", self.source(lines, context, feedback)]
        triangle = self.parameterAsString(parameters, "TRIANGLE", context)
        if triangle:
            arguments += ["--triangle", triangle]
        answer = run(arguments, feedback)
        return {"OUTPUT": output, "ORDERS": json.dumps(json.loads(answer)) if triangle else ""}
