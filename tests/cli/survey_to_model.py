#!/usr/bin/env python3
"""The worked example "From survey to model" of README runs as shown, and gives the figures that it names.

usage: survey_to_model.py THALWEG PROJECT
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def section(text, title):
    found = re.search(rf"^### {re.escape(title)}$(.*?)(?=^#{{1,3}} |\Z)", text, re.S | re.M)
    if not found:
        sys.exit(f"README has no section {title}")
    return found.group(1)


def figures(folder):
    """What the table of the section shows, by its rows."""
    def read(name):
        return json.loads((folder / name).read_text())

    surveyed, model = read("survey.json"), read("model.json")
    before, after = read("survey_water.json"), read("model_water.json")

    def share(report):
        held = report["consistency"]["result"]
        return f"{100 * held['draining_length_m'] / held['valley_length_m']:.1f} %"

    pair = ((surveyed, before), (model, after))
    return {
        "pits": [str(water["pits"]["interior"]) for _, water in pair],
        "volume to fill them": [f"{water['pits']['fill_volume_m3']:.0f} m3" for _, water in pair],
        "drawn valley edges that rise": [str(build["consistency"]["result"]["rising_edges"]) for build, _ in pair],
        "drawn valleys that drain": [share(build) for build, _ in pair],
        "heights changed": ["0", str(model["conditioned"]["heights"])],
        "by how much together": ["0 m", f"{model['conditioned']['sum_m']:.1f} m"],
    }


def main():
    thalweg, project = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    text = section((project / "README.md").read_text(), "From survey to model")
    commands = "\n".join(re.findall(r"^```sh$(.*?)^```$", text, re.S | re.M))
    if commands.count("thalweg ") < 5:
        sys.exit("the section has no commands")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        (folder / "sample_terrains").symlink_to(project / "sample_terrains")
        environment = os.environ | {"PATH": f"{thalweg.parent}:{os.environ['PATH']}"}
        subprocess.run(["sh", "-e", "-c", commands], cwd=folder, env=environment, check=True)
        named = set(re.findall(r"`([a-z_]+\.(?:nc|tif|shp|gpkg|ply|json|inp|png))`", text))
        missing = [name for name in sorted(named) if not (folder / name).exists()]
        if missing or not named:
            sys.exit(f"README names files that are not there: {missing}")
        wrong = []
        for row, values in figures(folder).items():
            line = f"| {row} | {values[0]} | {values[1]} |"
            if line not in text:
                wrong.append(line)
        if wrong:
            sys.exit("README's table does not have these rows:\n" + "\n".join(wrong))


if __name__ == "__main__":
    main()
