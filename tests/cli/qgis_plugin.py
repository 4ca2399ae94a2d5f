#!/usr/bin/env python3
"""The plugin in real QGIS, without a window: every algorithm by qgis_process, and cancel in the middle of a run.

Usage: qgis_plugin.py BINARY SOURCE [FOLDER]. The exit status is 77 where QGIS is not installed. With a folder, the
outputs stay there, with the project that QGIS made of them and its picture, map.png.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# Debian's wrapper hands on an option that the program does not know: the program itself, where it is there.
QGIS_PROCESS = shutil.which("qgis_process.bin") or shutil.which("qgis_process")
PYTHON = "/usr/bin/python3"

# How each script begins: QGIS without a window, with the plugin.
START = """
import os, sys
sys.path.append('/usr/share/qgis/python/plugins')
from qgis.core import QgsApplication
app = QgsApplication([], False)
app.initQgis()
from processing.core.Processing import Processing
Processing.initialize()
sys.path.append(os.environ['QGIS_PLUGINPATH'])
import thalweg_tin
plugin = thalweg_tin.classFactory(None)
plugin.initProcessing()
"""

CANCEL = START + """
import threading, time
from qgis.core import QgsProcessingContext, QgsProcessingFeedback
algorithm = QgsApplication.processingRegistry().algorithmById('thalweg:build')
feedback = QgsProcessingFeedback()
stop = {}
def cancel():
    stop['at'] = time.time()
    feedback.cancel()
threading.Timer(1.0, cancel).start()
try:
    algorithm.create().run({'INPUT': sys.argv[1], 'OUTPUT': sys.argv[2]}, QgsProcessingContext(), feedback,
                           catchExceptions=False)
    print('finished')
except Exception as error:
    print('stopped', time.time() - stop.get('at', 0) < 1.5, round(time.time() - stop.get('at', 0), 2), error)
print('left', sorted(os.listdir(os.path.dirname(sys.argv[2]))))
"""

# Runs two algorithms as the toolbox does, which loads and styles what they made; QGIS draws the project.
PROJECT = START + """
from qgis.core import (QgsMapRendererParallelJob, QgsMapSettings, QgsProcessingContext,
                       QgsProcessingFeedback, QgsProject)
from qgis.PyQt.QtCore import QSize
from processing.gui.Postprocessing import handleAlgorithmResults
project = QgsProject.instance()
registry = QgsApplication.processingRegistry()
def run(name, parameters):
    context, feedback = QgsProcessingContext(), QgsProcessingFeedback()
    context.setProject(project)
    algorithm = registry.algorithmById(name)
    results, right = algorithm.run(parameters, context, feedback)
    return right and handleAlgorithmResults(algorithm, context, feedback, parameters=parameters)
lines = sys.argv[1]
print('build', run('thalweg:build', {'INPUT': 'points.gpkg', 'Z_FIELD': 'z', 'VALLEYS': [lines + '|layername=valleys'],
                                     'RIDGES': [lines + '|layername=ridges'], 'OUTPUT': 'project.nc',
                                     'LAYERS': 'project.gpkg'}))
print('drain', run('thalweg:drain', {'INPUT': 'project.nc', 'OUTPUT': 'project_drain.gpkg'}))
layers = {}
for layer in project.mapLayers().values():
    layers.setdefault(layer.name(), layer)
print('names', sorted(layers), all(layer.isValid() for layer in layers.values()))
print('crs', {layer.crs().authid() for layer in layers.values()})
mesh, breaklines, pits = layers['project'], layers['Breaklines'], layers['Pits']
look = mesh.rendererSettings()
print('triangles shown', look.nativeMeshSettings().isEnabled())
shader = look.scalarSettings(look.activeScalarDatasetGroup()).colorRampShader()
print('heights', round(shader.minimumValue()), round(shader.maximumValue()))
print('kinds', [rule.label() for rule in breaklines.renderer().rootRule().children()][:2])
print('pits', pits.renderer().symbol().color().name(), pits.featureCount() > 0)
project.write('project.qgz')
settings = QgsMapSettings()
from thalweg_tin import build
for words in (build.DEFINITIONS, build.CROSSINGS, build.DUPLICATES, build.NODATA, build.METHODS):
    print('words', sorted(words))
order = ['Pits', 'Inconsistencies', 'Conflicts', 'Breaklines', 'Network', 'Catchments', 'project']
settings.setLayers([layers[name] for name in order])
settings.setDestinationCrs(mesh.crs())
settings.setExtent(mesh.extent())
settings.setOutputSize(QSize(1400, 1050))
job = QgsMapRendererParallelJob(settings)
job.start()
job.waitForFinished()
image = job.renderedImage()
image.save('map.png')
colors = {image.pixelColor(x, y).name() for x in range(image.width()) for y in range(0, image.height(), 3)}
print('drawn', [color in colors for color in ('#1f6fd0', '#8a4b08', '#0040ff', '#e02020')], len(colors) > 200)
"""

# CRSs that a layer has got in QGIS, or that QGIS made; formats that it does not read; programs that stop, or do not run.
DETAILS = START + r"""
import json
from processing.core.ProcessingConfig import ProcessingConfig
from qgis.core import (QgsCoordinateReferenceSystem as Crs, QgsCoordinateTransform, QgsMeshLayer, QgsProcessingContext,
                       QgsProcessingFeedback, QgsProject, QgsRasterLayer)
from thalweg_tin.program import SETTING, _Progress
registry = QgsApplication.processingRegistry()
thalweg, lines = os.environ['THALWEG_PROGRAM'], sys.argv[1]
class Feedback(QgsProcessingFeedback):
    stop_at = None
    def __init__(self):
        super().__init__()
        self.texts = []
    def pushCommandInfo(self, text):
        if self.stop_at and self.stop_at in text:
            self.cancel()
    def setProgressText(self, text):
        self.texts.append(text)
def run(name, parameters, stop_at=None):
    context, feedback = QgsProcessingContext(), Feedback()
    context.setProject(QgsProject.instance())
    feedback.stop_at = stop_at
    try:
        registry.algorithmById(name).create().run(parameters, context, feedback, catchExceptions=False)
        return sorted(os.path.basename(path) for path in context.layersToLoadOnCompletion())
    except Exception as error:
        return f'{type(error).__name__}: {error}'
def with_crs(layer, crs):
    layer.setCrs(Crs(crs) if crs else Crs())
    return layer

with open('degrees.asc', 'w') as dem:
    dem.write('ncols 3\nnrows 3\nxllcorner 10\nyllcorner 45\ncellsize 0.001\n1 2 3\n4 5 7\n3 1 2\n')
dem = with_crs(QgsRasterLayer('degrees.asc', 'dem'), 'EPSG:4326')
run('thalweg:build', {'INPUT': dem, 'OUTPUT': 'degrees.ply', 'REPORT': 'degrees.json'})
with open('degrees.json') as report:
    print('raster in degrees', json.load(report)['tin']['area_m2'] > 30000)

told = run('thalweg:export', {'INPUT': 'tin.ply', 'OUTPUT': 'told.2dm'})
bare = with_crs(QgsMeshLayer('told.2dm', 'bare', 'mdal'), None)
to_degrees = QgsCoordinateTransform(Crs('EPSG:32632'), Crs('EPSG:4326'), QgsProject.instance())
box = to_degrees.transformBoundingBox(bare.extent())
sides = f'{box.xMinimum()},{box.xMaximum()},{box.yMinimum()},{box.yMaximum()} [EPSG:4326]'
def to_raster(mesh, output):
    run('thalweg:tintoraster', {'INPUT': mesh, 'RESOLUTION': 10, 'EXTENT': sides, 'OUTPUT': output})
    raster = QgsRasterLayer(output, 'raster')
    return raster.crs().authid(), raster.extent().contains(bare.extent())
print('told mesh', to_raster(bare, 'told.tif'))
os.remove('told.prj')
print('assigned mesh', to_raster(with_crs(bare, 'EPSG:32632'), 'assigned.tif'))
ply = with_crs(QgsMeshLayer('tin.ply', 'ply', 'mdal'), 'EPSG:3035')
print('other CRS', run('thalweg:contours', {'INPUT': ply, 'OUTPUT': 'other.gpkg'}))

print('loaded', told, *(run('thalweg:optimize', {'INPUT': 'tin.ply', 'OUTPUT': f'loaded.{e}'}) for e in ('xml', 'NC')))

own = Crs.fromProj('+proj=tmerc +lon_0=9.5 +x_0=500000 +ellps=GRS80 +units=m')
own.saveAsUserCrs('own')
build = {'INPUT': 'points.gpkg', 'Z_FIELD': 'z', 'OUTPUT': 'own.ply'}
print('own CRS', own.authid(), run('thalweg:build', {**build, 'TARGET_CRS': own}),
      QgsMeshLayer('own.ply', '', 'mdal').crs() == own)

output = registry.algorithmById('thalweg:contours').parameterDefinition('OUTPUT')
print('outputs', output.supportsNonFileBasedOutput(),
      [output.isSupportedOutputValue(value, QgsProcessingContext())[0] for value in ('memory:', 'x.gpkg')])

progress = _Progress(Feedback())
for part in ('read 2DM     0', '...10', '... - done.\n', 'triangulate  ', '0', '.', 'WARNING: at most 0'):
    progress.feed(part)
    print('phases', progress.feedback.texts)

def program(name, text):
    with open(name, 'w') as file:
        file.write('#!/bin/sh\n' + text)
    os.chmod(name, 0o700)
    ProcessingConfig.setSettingValue(SETTING, os.path.abspath(name))
both = {**build, 'OUTPUT': 'both/tin.nc', 'LAYERS': 'both/tin.gpkg', 'REPORT': 'both/tin.json', 'PICTURE': 'both/tin.png'}
os.mkdir('both')
program('slow', f'[ $1 = convert ] && exec sleep 60\nexec "{thalweg}" "$@"\n')
print('second run', run('thalweg:build', both, stop_at='convert'), os.listdir('both'))
program('deaf', f'trap "" TERM\n"{thalweg}" "$@"\nexit 0\n')
print('done before', run('thalweg:build', {**build, 'OUTPUT': 'both/deaf.nc'}, stop_at='build'), os.listdir('both'))
os.chmod('deaf', 0o600)
print('not executable', run('thalweg:build', build))
os.remove('deaf')
print('missing', run('thalweg:build', build))
"""

# A model of two of the algorithms, as the designer saves it.
MODEL = START + """
from qgis.core import (QgsProcessingModelAlgorithm, QgsProcessingModelChildAlgorithm,
                       QgsProcessingModelChildParameterSource as Source, QgsProcessingModelOutput,
                       QgsProcessingModelParameter, QgsProcessingParameterFeatureSource)
model = QgsProcessingModelAlgorithm('terrain', 'tests')
model.addModelParameter(QgsProcessingParameterFeatureSource('points', 'Points'), QgsProcessingModelParameter('points'))
build = QgsProcessingModelChildAlgorithm('thalweg:build')
build.setChildId('build')
build.addParameterSources('INPUT', [Source.fromModelParameter('points')])
build.addParameterSources('Z_FIELD', [Source.fromStaticValue('z')])
model.addChildAlgorithm(build)
contours = QgsProcessingModelChildAlgorithm('thalweg:contours')
contours.setChildId('contours')
contours.addParameterSources('INPUT', [Source.fromChildOutput('build', 'OUTPUT')])
contours.addParameterSources('INTERVAL', [Source.fromStaticValue(25)])
lines = QgsProcessingModelOutput('contours', 'Contours')
lines.setChildOutputName('OUTPUT')
lines.setChildId('contours')
contours.setModelOutputs({'contours': lines})
model.addChildAlgorithm(contours)
print('saved', model.toFile('terrain.model3'))
"""


class Bench:
    """A QGIS with a profile of its own, in which only this plugin is switched on."""

    def __init__(self, binary, source, folder):
        self.folder = folder
        self.failed = 0
        home = os.path.join(folder, ".home")
        plugins = os.path.join(folder, ".plugins")
        os.makedirs(home, mode=0o700)
        os.makedirs(plugins)
        shutil.copytree(f"{source}/tools/qgis/thalweg_tin", f"{plugins}/thalweg_tin")
        self.env = dict(os.environ, HOME=home, XDG_RUNTIME_DIR=home, QT_QPA_PLATFORM="offscreen", LC_ALL="C.UTF-8", PATH="/usr/bin:/bin",
                        QGIS_PLUGINPATH=plugins, THALWEG_PROGRAM=binary, PYTHONDONTWRITEBYTECODE="1")

    def run(self, *command):
        done = subprocess.run(command, cwd=self.folder, env=self.env, capture_output=True, text=True, timeout=400)
        return done.returncode, done.stdout + done.stderr

    def check(self, name, right, text):
        self.failed += not right
        print(f"{'ok  ' if right else 'FAIL'} {name}" + ("" if right else f": {text[-1500:]}"), flush=True)

    def algorithm(self, name, output, **parameters):
        """Runs an algorithm and expects the file `output`."""
        arguments = [f"{key}={value}" for key, values in parameters.items()
                     for value in (values if isinstance(values, list) else [values])]
        status, text = self.run(QGIS_PROCESS, "run", f"thalweg:{name}", *(f"--{a}" for a in arguments))
        path = os.path.join(self.folder, output)
        self.check(f"thalweg:{name} {output}", status == 0 and os.path.getsize(path) > 0
                   if os.path.exists(path) else False, text)
        return text


def main():
    if QGIS_PROCESS is None:
        print("skip QGIS is not installed (qgis_process)")
        return 77
    binary, source = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    with tempfile.TemporaryDirectory() as work:
        folder = os.path.abspath(sys.argv[3]) if len(sys.argv) > 3 else work
        os.makedirs(folder, exist_ok=True)
        bench = Bench(binary, source, folder)
        bench.run(QGIS_PROCESS, "plugins", "enable", "thalweg_tin")
        listed = pathlib.Path(source, "tools", "qgis", "CMakeLists.txt").read_text().split("set(files")[1].split(")")[0].split()
        there = {path.name for path in pathlib.Path(source, "tools", "qgis", "thalweg_tin").iterdir() if path.is_file()}
        bench.check("the zip holds all files", set(listed) == there, f"{sorted(listed)} {sorted(there)}")
        survey = pathlib.Path(source, "sample_terrains", "survey")
        subprocess.run(["ogr2ogr", f"{folder}/points.gpkg", str(survey / "points.csv"), "-oo", "X_POSSIBLE_NAMES=x", "-oo",
                        "Y_POSSIBLE_NAMES=y", "-oo", "AUTODETECT_TYPE=YES", "-a_srs", "EPSG:32632"], check=True)
        lines = survey / "lines.gpkg"
        bench.algorithm("build", "tin.ply", INPUT=f"{folder}/points.gpkg", Z_FIELD="z", VALLEYS=f"{lines}|layername=valleys",
                        RIDGES=f"{lines}|layername=ridges", OUTPUT=f"{folder}/tin.ply", REPORT=f"{folder}/report.json",
                        LAYERS=f"{folder}/layers.gpkg")
        report = json.load(open(f"{folder}/report.json"))
        bench.check("report", report["criteria"][0]["optimal"], str(report["criteria"]))
        subprocess.run([binary, "build", f"{folder}/points.gpkg", f"{folder}/same.ply", "-q", "--z-field", "z",
                        "--valleys", f"{lines}|layername=valleys", "--ridges", f"{lines}|layername=ridges"], check=True)
        same = pathlib.Path(folder, "same.ply").read_bytes() == pathlib.Path(folder, "tin.ply").read_bytes()
        bench.check("same bytes as the command line", same, "they differ")
        dem = str(pathlib.Path(source, "sample_terrains", "jacksboro", "dem.tif"))
        bench.algorithm("simplify", "simple.ply", INPUT=dem, MAX_ERROR=20, OUTPUT=f"{folder}/simple.ply",
                        REPORT=f"{folder}/simple.json")
        simple = json.load(open(f"{folder}/simple.json"))["simplification"]
        bench.check("within the bound", simple["stopped_by"] == "max-error" and
                    simple["largest_error_m"]["result"] <= 20, str(simple))
        status, text = bench.run(QGIS_PROCESS, "run", "thalweg:simplify", f"--INPUT={dem}", "--MAX_POINTS=2",
                                 f"--OUTPUT={folder}/no.ply")
        bench.check("too few points are refused", status != 0, text)
        lake = f"{folder}/lake.geojson"
        with open(lake, "w") as file:
            ring = [[676300, 5148300], [676420, 5148310], [676400, 5148420], [676290, 5148400], [676300, 5148300]]
            json.dump({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "EPSG:32632"}},
                       "features": [{"type": "Feature", "properties": {"level": 440.5},
                                     "geometry": {"type": "Polygon", "coordinates": [ring]}}]}, file)
        bench.algorithm("build", "lake.ply", INPUT=f"{folder}/points.gpkg", Z_FIELD="z", LAKES=lake, LINE_Z_FIELD="level",
                        OUTPUT=f"{folder}/lake.ply", REPORT=f"{folder}/lake.json")
        bench.check("a lake", json.load(open(f"{folder}/lake.json"))["input"]["lakes"] == 1, "there is none")
        hills = f"{source}/sample_terrains/jacksboro"
        bench.algorithm("build", "hills.nc", INPUT=f"{hills}/dem.tif", VALLEYS=f"{hills}/lines.gpkg|layername=valleys_3d",
                        TARGET_CRS="EPSG:32617", OUTPUT=f"{folder}/hills.nc")
        tin = f"{folder}/tin.ply"
        bench.algorithm("optimize", "delaunay.ply", INPUT=tin, OPTIMIZE="none", OUTPUT=f"{folder}/delaunay.ply")
        bench.algorithm("orders", "quads.csv", INPUT=f"{folder}/points.gpkg", TRIANGLE="0,1,2", DEFINITION=7,
                        OUTPUT=f"{folder}/quads.csv")
        bench.algorithm("tintoraster", "dem.tif", INPUT=tin, RESOLUTION=5, OUTPUT=f"{folder}/dem.tif")
        bench.algorithm("contours", "contours.gpkg", INPUT=tin, INTERVAL=10, OUTPUT=f"{folder}/contours.gpkg")
        bench.algorithm("tintolayers", "more.gpkg", INPUT=tin, OUTPUT=f"{folder}/more.gpkg")
        bench.algorithm("drain", "drain.gpkg", INPUT=tin, OUTPUT=f"{folder}/drain.gpkg", SEED_SPACING=50,
                        REPORT=f"{folder}/drain.json")
        bench.algorithm("drain", "seedless.gpkg", INPUT=tin, OUTPUT=f"{folder}/seedless.gpkg", SEED_SPACING=0)
        bench.algorithm("profile", "profile.csv", INPUT=tin, LINES=f"{lines}|layername=valleys",
                        OUTPUT=f"{folder}/profile.csv")
        subprocess.run([binary, "convert", tin, f"{folder}/same.csv", "-q", "--profile", f"{lines}|layername=valleys"],
                       check=True)
        same = pathlib.Path(folder, "same.csv").read_bytes() == pathlib.Path(folder, "profile.csv").read_bytes()
        bench.check("profile: same bytes as the command line", same, "they differ")
        told = subprocess.run([binary, "info", tin, "-f", "json", "--volume-above=450"], check=True, capture_output=True,
                              text=True).stdout
        above = json.loads(told)["volumes"][0]["above_m3"]
        _, text = bench.run(QGIS_PROCESS, "run", "thalweg:volume", f"--INPUT={tin}", "--HEIGHT=450")
        found = re.search(r"^ABOVE:\s*(\S+)", text, re.MULTILINE)
        bench.check("thalweg:volume above a height", found and abs(float(found.group(1)) - above) <= 1e-5 * above, text)
        _, text = bench.run(QGIS_PROCESS, "run", "thalweg:volume", f"--INPUT={tin}", f"--REFERENCE={folder}/lake.ply")
        bench.check("thalweg:volume between two TINs", "NET:" in text, text)
        status, text = bench.run(QGIS_PROCESS, "run", "thalweg:volume", f"--INPUT={tin}")
        bench.check("thalweg:volume wants a reference", status != 0 and "not both" in text, text)
        bench.algorithm("export", "tin.xml", INPUT=tin, OUTPUT=f"{folder}/tin.xml")
        status, text = bench.run(QGIS_PROCESS, "run", "thalweg:build", f"--INPUT={folder}/points.gpkg",
                                 "--OPTIMIZE=beauty", f"--OUTPUT={folder}/no.ply")
        bench.check("error in the program's words", status != 0 and "beauty" in text, text)

        step = 0.5  # a million points: long enough to be stopped in the middle
        with open(f"{folder}/many.csv", "w") as many:
            for i in range(1000):
                many.write("".join(f"{i * step},{j * step},{(i * j) % 97}\n" for j in range(1000)))
        subprocess.run(["ogr2ogr", f"{folder}/many.gpkg", f"{folder}/many.csv", "-oo", "X_POSSIBLE_NAMES=field_1", "-oo",
                        "Y_POSSIBLE_NAMES=field_2", "-oo", "Z_POSSIBLE_NAMES=field_3"], check=True)
        os.makedirs(f"{folder}/stopped")
        _, text = bench.run(PYTHON, "-c", CANCEL, f"{folder}/many.gpkg", f"{folder}/stopped/tin.ply")
        seconds = re.search(r"stopped \w+ ([0-9.]+)", text)
        bench.check(f"cancel stops after {seconds.group(1) if seconds else '?'} s and leaves nothing",
                    "stopped True" in text and "left []" in text, text)
        _, text = bench.run(PYTHON, "-c", PROJECT, str(lines))
        for line in ("build True", "drain True", "crs {'EPSG:32632'}", "triangles shown True", "kinds ['Valleys', 'Ridges']",
                     "heights 400 521", "pits #0040ff True", "drawn [True, True, True, True] True"):
            bench.check(f"project: {line}", line in text, text)
        told = subprocess.run([binary, "build", "--help"], check=True, capture_output=True, text=True).stdout
        definitions = re.search(r"which constrained order: (.*)", told).group(1).split(", ")
        choices = [re.search(rf"--{option} \{{([^}}]*)\}}", told).group(1).split(",")
                   for option in ("crossing", "duplicates", "nodata")]
        for words in (definitions, *choices):
            bench.check(f"choices: {', '.join(words)}", f"words {sorted(words)}" in text, text)
        _, text = bench.run(PYTHON, "-c", DETAILS, str(lines))
        for name, line in (
                ("a raster's CRS in QGIS counts", "raster in degrees True"),
                ("a mesh's .prj counts", "told mesh ('EPSG:32632', True)"),
                ("a mesh's CRS in QGIS counts", "assigned mesh ('EPSG:32632', True)"),
                ("another CRS than a PLY's is refused",
                 "other CRS QgsProcessingException: The layer ply has the CRS EPSG:3035"),
                ("only meshes that QGIS reads are loaded", "loaded ['told.2dm'] [] ['loaded.NC']"),
                ("a user's CRS", "own CRS USER:100000 ['own.ply'] True"),
                ("outputs are files", "outputs False [False, True]"),
                ("a phase is told as it starts", "phases ['read 2DM']\nphases ['read 2DM']\nphases ['read 2DM']\n"
                 "phases ['read 2DM']\nphases ['read 2DM', 'triangulate']\n"),
                ("cancel of the second run leaves nothing",
                 "second run QgsProcessingException: Stopped; no output was left. []"),
                ("a run that was done is not stopped", "done before ['deaf.nc'] ['deaf.nc']"),
                ("a program that cannot be executed", "deaf cannot be run: Permission denied. Install thalweg, or name it"),
                ("a program that is missing", "deaf cannot be run: No such file or directory. Install thalweg, or name it")):
            bench.check(name, line in text, text)
        _, text = bench.run(PYTHON, "-c", MODEL)
        bench.check("model saved", "saved True" in text, text)
        status, text = bench.run(QGIS_PROCESS, "run", f"{folder}/terrain.model3", f"--points={folder}/points.gpkg",
                                 f"--contours:contours={folder}/of_model.gpkg")
        bench.check("model run", status == 0 and os.path.exists(f"{folder}/of_model.gpkg"), text)
        print(f"{bench.failed} failed")
        return 1 if bench.failed else 0


if __name__ == "__main__":
    sys.exit(main())
