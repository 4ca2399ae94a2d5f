#!/usr/bin/env python3
"""Runs the command-line cases: each is a folder with

  cmd      a shell script; $THALWEG is the binary, $CASE the folder, $SOURCE the project; run in an empty folder
  status   the exit status that is expected (default 0)
  stdout   regular expressions, one a line, each of which must be found in standard output
  stderr   the same for standard error
  files    the names that must be left in the folder, sorted, one a line (default: not looked at)

A case that fails (status not 0) must print exactly one line on standard error, which starts with ERROR, and
must leave no temporary file. Usage: run_cases.py BINARY SOURCE [CASE...]
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def read(folder, name, default=None):
    path = folder / name
    return path.read_text() if path.exists() else default


def missing(patterns, text, where):
    return [f"{where}: no match for /{p}/ in: {text.strip()[:400]}"
            for p in (patterns or "").splitlines() if p and not re.search(p, text, re.M)]


def run(folder, binary, source):
    expected = int(read(folder, "status", "0"))
    with tempfile.TemporaryDirectory() as work:
        env = dict(os.environ, THALWEG=binary, CASE=str(folder), SOURCE=source, LC_ALL="C.UTF-8")
        done = subprocess.run(["bash", str(folder / "cmd")], cwd=work, env=env, capture_output=True, timeout=110)
        out, err = done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")
        left = sorted(os.listdir(work))
    faults = []
    if done.returncode != expected:
        faults.append(f"status {done.returncode}, expected {expected}; stderr: {err.strip()[:400]}")
    faults += missing(read(folder, "stdout"), out, "stdout") + missing(read(folder, "stderr"), err, "stderr")
    if expected != 0 and (len(err.splitlines()) != 1 or not err.startswith("ERROR ")):
        faults.append(f"stderr is not one ERROR line: {err.strip()[:400]}")
    files = read(folder, "files")
    if files is not None and left != files.split():
        faults.append(f"files left: {left}, expected {files.split()}")
    faults += [f"temporary file left: {name}" for name in left if name.startswith(".")]
    return faults


def main():
    binary, source = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    cases = pathlib.Path(__file__).parent / "cases"
    names = sys.argv[3:] or sorted(p.name for p in cases.iterdir() if p.is_dir())
    failed = 0
    for name in names:
        faults = run(cases / name, binary, source)
        failed += bool(faults)
        print(("FAIL " if faults else "ok   ") + name)
        for fault in faults:
            print("     " + fault)
    print(f"{len(names) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
