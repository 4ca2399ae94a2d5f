"""Optimise existing TIN."""

from qgis.core import (QgsProcessingParameterFileDestination, QgsProcessingParameterMeshLayer,
                       QgsProcessingParameterEnum, QgsProcessingParameterNumber, QgsProcessingParameterString)

from .algorithm import MESHES, ThalwegAlgorithm
from .build import DEFINITIONS, METHODS
from .program import run


class OptimizeTin(ThalwegAlgorithm):
    """The same optimisation on a mesh that exists."""

    NAME = "optimize"
    TITLE = "Optimise existing TIN"
    GROUP = "TIN"
    HELP = """Chooses the diagonals of a TIN that exists: fewest pits first, then the smoothest surface. Vertices,
heights, outline and constraint edges stay; the other edges are those of the constrained Delaunay triangulation and its
first-order alternatives. The mesh has to be a file that Thalweg reads: PLY, UGRID, 2DM."""

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMeshLayer("INPUT", "TIN"))
        self.addParameter(QgsProcessingParameterNumber("ORDER", "Largest order of a triangle", defaultValue=1,
                                                       minValue=0))
        self.advanced(QgsProcessingParameterString("OPTIMIZE", "Criteria, in order of priority (none: Delaunay)",
                                                   defaultValue="local-minima,normal-angle-sum"))
        self.advanced(QgsProcessingParameterEnum("DEFINITION", "Which constrained order", DEFINITIONS, defaultValue=0))
        self.advanced(QgsProcessingParameterEnum("METHOD", "How fewest pits are found: exactly, or by a published heuristic",
                                                 METHODS, defaultValue=0))
        self.addParameter(QgsProcessingParameterFileDestination("OUTPUT", "Optimised TIN", MESHES))
        self.add_report()

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        output = self.parameterAsFileOutput(parameters, "OUTPUT", context)
        arguments = ["optimize", self.mesh_path(parameters, "INPUT", context), output, "--overwrite", "--progress",
                     "--order", str(self.parameterAsInt(parameters, "ORDER", context)),
                     "--definition", DEFINITIONS[self.parameterAsEnum(parameters, "DEFINITION", context)],
                     "--method", METHODS[self.parameterAsEnum(parameters, "METHOD", context)]]
        criteria = self.parameterAsString(parameters, "OPTIMIZE", context)
        if criteria:
            arguments += ["--optimize", criteria]
        results = {"OUTPUT": output}
        arguments += self.report_arguments(parameters, context, results)
        run(arguments, feedback)
        self.load_mesh(output, "Optimised TIN", "OUTPUT", context)
        return results
