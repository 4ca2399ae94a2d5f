"""Drainage report."""

from qgis.core import (QgsProcessing, QgsProcessingParameterFileDestination, QgsProcessingParameterMapLayer,
                       QgsProcessingParameterMeshLayer, QgsProcessingParameterNumber, QgsVectorLayer)

from .algorithm import ThalwegAlgorithm
from .program import run


class DrainageReport(ThalwegAlgorithm):
    """Pits, flow paths, network and catchments of a TIN."""

    NAME = "drain"
    TITLE = "Drainage report"
    GROUP = "Hydrology"
    KEYWORDS = ["tin", "hydrology", "pits", "depressions", "flow", "catchments", "watersheds", "streams"]
    HELP = """Follows water down the surface of a TIN: pits with their depth, area and volume, flow paths from points or
from a lattice, the drainage network, catchments that tile the TIN, and where drawn valleys rise or water crosses drawn
ridges. Heights are not changed. The layers are loaded; the report is JSON."""

    def initAlgorithm(self, config=None):  # noqa: N802
        self.addParameter(QgsProcessingParameterMeshLayer("INPUT", "TIN"))
        for name, label in (("OUTLETS", "Points where water leaves"), ("SEEDS", "Points from which paths are followed")):
            self.addParameter(QgsProcessingParameterMapLayer(name, label, optional=True,
                                                             types=[QgsProcessing.TypeVectorPoint]))
        for name, label in (("SEED_SPACING", "Follow paths from a lattice (metres)"),
                            ("MIN_AREA", "Least area that a reach of the network drains (m2)"),
                            ("PASS_PITS", "Pits at most so deep are full (metres)")):
            self.advanced(QgsProcessingParameterNumber(name, label, QgsProcessingParameterNumber.Double, optional=True,
                                                       minValue=0))
        self.addParameter(QgsProcessingParameterFileDestination("OUTPUT", "Layers", "GeoPackage (*.gpkg)"))
        self.add_report()

    def processAlgorithm(self, parameters, context, feedback):  # noqa: N802
        output = self.parameterAsFileOutput(parameters, "OUTPUT", context)
        arguments = ["drain", self.mesh_path(parameters, "INPUT", context), output, "--overwrite", "--progress"]
        for name, option in (("OUTLETS", "--outlets"), ("SEEDS", "--seeds")):
            layer = self.parameterAsLayer(parameters, name, context)
            if layer is not None:
                arguments += [option, self.source(layer, context, feedback)]
        for name, option in (("SEED_SPACING", "--seed-spacing"), ("MIN_AREA", "--min-area"),
                             ("PASS_PITS", "--pass-pits")):
            if parameters.get(name) is None:
                continue
            value = self.parameterAsDouble(parameters, name, context)
            if value > 0 or name != "SEED_SPACING":  # a lattice of no width is none
                arguments += [option, repr(value)]
        results = {"OUTPUT": output}
        arguments += self.report_arguments(parameters, context, results)
        run(arguments, feedback)
        inconsistent = QgsVectorLayer(f"{output}|layername=inconsistencies").featureCount() > 0
        names = ("catchments", "network", "flow_paths", *(["inconsistencies"] if inconsistent else []), "pits")
        self.load_layers(output, names, "OUTPUT", context)
        return results
