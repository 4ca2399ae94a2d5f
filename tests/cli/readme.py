#!/usr/bin/env python3
"""Runs what README shows, as it stands there, and the examples of each command's --help.

A block of commands, C or Python is run whole, in README's order and in one folder that holds sample_terrains; it must
succeed, and print what stands after #> or //>. Commands of tools/dev are left out: they build and test the project.
Blocks that need QGIS, a C compiler or NumPy are skipped, by name, where there is none.

Usage: readme.py BINARY LIBRARY SOURCE
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

BINARY, LIBRARY, SOURCE = (os.path.abspath(path) for path in sys.argv[1:4])
QGIS_PROCESS = shutil.which("qgis_process.bin") or shutil.which("qgis_process")
PYTHON = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable
COMMANDS = r"^(thalweg|qgis_process|ogr2ogr|gdalinfo|ogrinfo|cd) "


def blocks(text):
    """Pairs of language and text; none for diagrams, nor for what survey_to_model.py runs, which is marked sh."""
    for language, body in re.findall(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        if language == "sh":
            continue
        if language or re.search(COMMANDS, body, re.MULTILINE):
            yield language or "bash", body


def needs(language, body):
    """What the block needs and is not there."""
    if language == "c" and not shutil.which("cc"):
        return "a C compiler"
    if language == "python" and subprocess.run([PYTHON, "-c", "import numpy"], capture_output=True).returncode:
        return "NumPy"
    if "qgis_process" in body and QGIS_PROCESS is None:
        return "QGIS"
    return None


def environment(folder):
    """Where the program, the library, the package and the plugin are found, and nothing of the user's."""
    tools = f"{folder}/.tools"
    os.makedirs(tools)
    os.makedirs(f"{folder}/.home", mode=0o700)
    os.symlink(BINARY, f"{tools}/thalweg")
    if QGIS_PROCESS:
        os.symlink(QGIS_PROCESS, f"{tools}/qgis_process")
    return dict(os.environ, PATH=f"{tools}:/usr/bin:/bin", HOME=f"{folder}/.home", XDG_RUNTIME_DIR=f"{folder}/.home",
                LC_ALL="C.UTF-8", QT_QPA_PLATFORM="offscreen", QGIS_PLUGINPATH=f"{SOURCE}/tools/qgis",
                THALWEG_LIBRARY=LIBRARY, LD_LIBRARY_PATH=os.path.dirname(LIBRARY), PYTHONPATH=f"{SOURCE}/tools/python",
                PYTHONDONTWRITEBYTECODE="1")


def command_of(language, body, folder):
    if language == "bash":
        return ["bash", "-e", "-c", body]
    path = f"{folder}/.block.{'c' if language == 'c' else 'py'}"
    with open(path, "w", encoding="utf-8") as file:
        file.write(body)
    if language == "python":
        return [PYTHON, path]
    build = (f"cc -std=c11 -Wall -Werror -I {SOURCE}/include {path} {LIBRARY} -o {folder}/.block && {folder}/.block")
    return ["bash", "-c", build]


def run(name, language, body, folder, env):
    """0 if the block does what it shows."""
    missing = needs(language, body)
    if missing:
        print(f"skip {name}: there is no {missing}")
        return 0
    try:
        done = subprocess.run(command_of(language, body, folder), cwd=folder, env=env, capture_output=True, text=True,
                              timeout=500)
    except subprocess.TimeoutExpired:
        print(f"FAIL {name}: it takes too long")
        return 1
    said = done.stdout + done.stderr
    faults = [f"status {done.returncode}: {said[-700:]}"] if done.returncode != 0 else []
    for promised in re.findall(r"^(?:#|//)> (.*)$", body, re.MULTILINE):
        if promised not in said:
            faults.append(f"does not print '{promised}' but: {said[-700:]}")
    print(f"{'FAIL' if faults else 'ok  '} {name}", flush=True)
    for fault in faults:
        print("     " + fault)
    return 1 if faults else 0


def run_readme(folder, env):
    shutil.copytree(f"{SOURCE}/sample_terrains", f"{folder}/sample_terrains")
    text = open(f"{SOURCE}/README.md", encoding="utf-8").read()
    found = list(blocks(text))
    if len(found) < 8:
        print(f"FAIL README shows {len(found)} blocks; are they still found?")
        return 1
    return sum(run(f"README, {language}: {body.splitlines()[0]}", language, body, folder, env)
               for language, body in found)


def run_help(folder, env):
    """Each line of Examples in a folder that has the files which examples name."""
    thalweg = lambda *arguments: subprocess.run([BINARY, *arguments], check=True, capture_output=True, text=True)
    survey = f"{SOURCE}/sample_terrains/survey"
    prepared = f"{folder}/prepared"
    os.makedirs(prepared)
    for file in (f"{survey}/points.csv", f"{survey}/lines.gpkg", f"{SOURCE}/sample_terrains/jacksboro/dem.tif"):
        shutil.copy(file, prepared)
    made = {"tin.ply": ["--report", "report.json"], "before.ply": ["--optimize", "none"]}
    failed = 0
    commands = re.findall(r"^  ([a-z]+) ", thalweg("--help").stdout.split("Subcommands:")[1], re.MULTILINE)
    for command in commands:
        examples = re.search(r"^Examples:\n((?:  thalweg .*\n)+)", thalweg(command, "--help").stdout, re.MULTILINE)
        if not examples:
            if command != "formats":
                print(f"FAIL {command} --help shows no examples")
                failed += 1
            continue
        place = f"{folder}/{command}"
        shutil.copytree(prepared, place)
        if command not in ("build", "order"):
            for name, options in made.items():
                subprocess.run([BINARY, "build", "points.csv", name, "-q", "--a-crs", "EPSG:32632", *options], cwd=place,
                               check=True)
        for example in examples.group(1).splitlines():
            failed += run(f"{command} --help: {example.strip()}", "bash", example.strip(), place, env)
    return failed


def main():
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        env = environment(folder)
        os.makedirs(f"{folder}/readme")
        failed += run_readme(f"{folder}/readme", env)
        os.makedirs(f"{folder}/help")
        failed += run_help(f"{folder}/help", env)
    print(f"{failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
