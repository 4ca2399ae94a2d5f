#!/usr/bin/env python3
"""Too little memory at any moment: `ulimit -v` from little above what the program alone needs (below, GDAL itself aborts)
up to what suffices. Each run ends
whole, or with one line and the status of a failure and no file; by the estimate first, by the allocator else.

Usage: memory.py BINARY; status 77 where the program cannot run under such limits (sanitizers).
"""
import os
import pathlib
import random
import re
import resource
import subprocess
import sys
import tempfile

BINARY = os.path.abspath(sys.argv[1])
MEBIBYTE = 1 << 20


def run(mebibytes, *arguments):
    limit = (mebibytes * MEBIBYTE, mebibytes * MEBIBYTE)
    return subprocess.run([BINARY, *arguments], capture_output=True, text=True, timeout=120,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, limit))


def least():
    return next((m for m in range(60, 600, 10) if run(m, "--version").returncode == 0), None)


def main():
    random.seed(7)
    base = least()
    if base is None:
        print("the program cannot run under ulimit -v: skipped")
        return 77
    rows = "".join(f"{random.random() * 1e4},{random.random() * 1e4},{i % 97}\n" for i in range(150000))
    answers, faults = set(), []
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        pathlib.Path("p.csv").write_text("x,y,z\n" + rows)
        for more in (*range(10, 100, 10), 100, 130, 160, 200, 300, 500):
            done = run(base + more, "build", "p.csv", "out.ply", "-q")
            left = sorted(os.listdir("."))
            if done.returncode == 0:
                answers.add("built")
                os.remove("out.ply")
            elif done.returncode == 1 and re.fullmatch(r"ERROR out-of-memory: .+\n", done.stderr) and left == ["p.csv"]:
                answers.add("estimate" if "ulimit -v leaves" in done.stderr else "allocator")
            else:
                faults.append(f"{base + more} MiB: status {done.returncode}, left {left}: {done.stderr.strip()[:300]}")
            print(f"{base + more:>5} MiB  status {done.returncode}  {done.stderr.strip()[:150]}")
        os.chdir("/")
    if not {"built", "estimate"} <= answers:
        faults.append(f"answers are {sorted(answers)} alone")
    print("\n".join(faults) or "every limit was answered")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
