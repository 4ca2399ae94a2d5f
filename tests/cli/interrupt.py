#!/usr/bin/env python3
"""Stops runs at moments spread over their whole length, and looks at what is left on disk.

After SIGINT, SIGTERM or SIGHUP: status 130, one ERROR line, and no file, temporary or final; or the run had finished and
everything is there. After SIGKILL: a target holds what it held before, or the whole new file.
Usage: interrupt.py BINARY [POINTS [MOMENTS]]; prints the longest time from signal to end.
"""
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

# Far above what is promised (a second), so that a loaded machine does not fail: hanging is what is looked for.
LONGEST_S = 10


def write_points(path, count):
    noise = random.Random(7)
    with open(path, "w") as file:
        file.write("x,y,z\n")
        for _ in range(count):
            file.write(f"{noise.uniform(0, 1e4):.3f},{noise.uniform(0, 1e4):.3f},{noise.uniform(0, 100):.2f}\n")


def start(binary, points, folder):
    return subprocess.Popen(
        [binary, "build", points, "t.gpkg", "--report", "r.json", "--picture", "p.png", "--overwrite", "-q"],
        cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))  # what runs the tests may ignore it


def stop(binary, points, number, after):
    """One run that gets a signal; the faults found, and the seconds that it went on."""
    with tempfile.TemporaryDirectory() as folder:
        old = pathlib.Path(folder, "r.json")
        if number == signal.SIGKILL:
            old.write_text("old")
        run = start(binary, points, folder)
        time.sleep(after)
        sent = time.monotonic()
        run.send_signal(number)
        _, err = run.communicate(timeout=60)
        took = time.monotonic() - sent
        left = sorted(os.listdir(folder))
        if run.returncode == 0:
            return ([] if left == ["p.png", "r.json", "t.gpkg"] else [f"finished, but left {left}"]), 0
        if number == signal.SIGKILL:
            text = old.read_text()
            return ([] if text == "old" or text.rstrip().endswith("}") else ["the report is torn"]), took
        faults = []
        if run.returncode != 130:
            faults.append(f"status {run.returncode}")
        if len(err.splitlines()) != 1 or not err.startswith("ERROR cancelled"):
            faults.append(f"stderr is {err!r}")
        if left:
            faults.append(f"left {left}")
        if took > LONGEST_S:
            faults.append(f"went on for {took:.1f} s")
        return faults, took


def main():
    binary = os.path.abspath(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 60_000
    moments = int(sys.argv[3]) if len(sys.argv) > 3 else 8
    failed, longest = 0, (0, "")
    with tempfile.TemporaryDirectory() as folder:
        points = os.path.join(folder, "points.csv")
        write_points(points, count)
        # A program that is still being loaded hears no signal.
        begin = time.monotonic()
        subprocess.run([binary, "--version"], stdout=subprocess.DEVNULL, check=True)
        loaded = max(0.3, 3 * (time.monotonic() - begin))
        begin = time.monotonic()
        run = start(binary, points, folder)
        run.communicate()
        whole = time.monotonic() - begin
        if run.returncode != 0:
            print(f"the run itself fails with status {run.returncode}")
            return 1
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL):
            for i in range(moments):
                after = loaded + whole * i / moments
                faults, took = stop(binary, points, number, after)
                failed += bool(faults)
                longest = max(longest, (took, f"{number.name} after {after:.2f} s"))
                for fault in faults:
                    print(f"{number.name} after {after:.2f} of {whole:.2f} s: {fault}")
    print(f"{failed} failed; longest from signal to end {longest[0]:.2f} s ({longest[1]})")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
