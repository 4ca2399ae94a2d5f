"""One run of QGIS's TIN mesh creation: points of a layer with heights to a mesh. Usage: qgis_tin.py LAYER OUTPUT.ply"""
import sys

from qgis.analysis import QgsNativeAlgorithms
from qgis.core import QgsApplication, QgsProcessingContext, QgsProcessingFeedback, QgsVectorLayer, QgsProject

application = QgsApplication([], False)
application.initQgis()
QgsApplication.processingRegistry().addProvider(QgsNativeAlgorithms())
layer = QgsVectorLayer(sys.argv[1], "points")
QgsProject.instance().addMapLayer(layer)
context = QgsProcessingContext()
context.setProject(QgsProject.instance())
algorithm = QgsApplication.processingRegistry().algorithmById("native:tinmeshcreation")
_, done = algorithm.run({"SOURCE_DATA": [{"source": layer.id(), "type": 0, "attributeIndex": -1}], "MESH_FORMAT": 2,
                         "CRS_OUTPUT": layer.crs(), "OUTPUT_MESH": sys.argv[2]}, context, QgsProcessingFeedback(True))
application.exitQgis()
sys.exit(0 if done else 1)
