#!/usr/bin/env python3
"""The man pages: one for each command, with every option of its --help, and without a complaint of groff.

Usage: man_pages.py BINARY SOURCE
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main():
    binary, source = sys.argv[1:3]
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, f"{source}/tools/dev/make_man", binary, folder], check=True)
        commands = re.findall(r"^  ([a-z]+) ", output(binary, "--help").split("Subcommands:")[1], re.MULTILINE)
        expected = {"thalweg.1", *(f"thalweg-{command}.1" for command in commands)}
        if set(os.listdir(folder)) != expected:
            print(f"FAIL pages: {sorted(os.listdir(folder))}, expected {sorted(expected)}")
            failed += 1
        for command in commands:
            text = output(binary, command, "--help")
            page = open(f"{folder}/thalweg-{command}.1", encoding="utf-8").read().replace("\\-", "-")
            options = set(re.findall(r"^  (?:-[a-z],)?(--[a-z-]+)", text, re.MULTILINE))
            missing = [option for option in options if not re.search(rf"^\S*.*{option}\b", page, re.MULTILINE)]
            if not options or missing or any(ord(c) < 32 and c != "\n" for c in text + page):
                print(f"FAIL {command}: {missing}")
                failed += 1
            if shutil.which("groff"):
                done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", f"{folder}/thalweg-{command}.1"],
                                      capture_output=True, text=True)
                if done.returncode != 0 or done.stderr:
                    print(f"FAIL {command}: {done.stderr}")
                    failed += 1
    print(f"{failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
