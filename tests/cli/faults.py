#!/usr/bin/env python3
"""What fails around the program: disks, files, memory, descriptors, signals. Each fault gets one ERROR line and a
status, and on disk is afterwards the old file or the new one, whole.

Prints a table: fault, answer, what is on disk. Each run overwrites a file that exists, so that losing it would show.
Usage: faults.py BINARY; a full disk needs the right to mount a tmpfs in a namespace of its own, an unreadable file
one to become nobody, both as root; what cannot be tried is named.
"""
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

sys.dont_write_bytecode = True
from interrupt import write_points

BINARY, SCRIPT = os.path.abspath(sys.argv[1]), os.path.abspath(__file__)
MESHES = (".ply", ".nc", ".xml", ".2dm", ".obj", ".off", ".stl", ".glb", ".vtu", ".gpkg", ".fgb", ".shp", ".geojson")
OLD = b"old"
rows, faults = [], []


def run(*arguments, **options):
    return subprocess.run([BINARY, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=300, **options)


def answer(done):
    err = done.stderr.decode(errors="replace")
    if done.returncode == 0:
        return "done"
    if len(err.splitlines()) == 1 and err.startswith("ERROR ") and done.returncode in (1, 2, 130):
        return err.split()[1].rstrip(":")
    return f"status {done.returncode}: {err.strip()[:300]}"


def whole(path):
    """Whether the file is read back as a TIN."""
    return run("info", path, "-q").returncode == 0


def judge(fault, done, expected, target=None, folder=".", keep=()):
    """Notes the answer and what is on disk; what is not as it should be is a fault of the program."""
    got = answer(done)
    disk = "nothing"
    if target is not None and os.path.exists(target):
        content = pathlib.Path(target).read_bytes()
        disk = "the old file" if content == OLD else "the new file" if whole(target) else "NEITHER OLD NOR NEW"
    left = [name for name in os.listdir(folder) if name.startswith(".thalweg-")] if os.path.isdir(folder) else []
    if left:
        disk += f", and {left}"
    wanted = "the new file" if got == "done" else "the old file" if target else "nothing"
    if got not in expected.split(" or ") or disk != wanted:
        faults.append(f"{fault}: {got}, on disk {disk}; expected {expected}, {wanted}")
    rows.append((fault, got, disk))


def new_target(name="out.ply"):
    pathlib.Path(name).write_bytes(OLD)
    return name


def limited(which, value):
    return lambda: resource.setrlimit(which, (value, value))


# --- disks

def short_writes():
    """A file can be so many bytes long and no longer: writes are cut at every length."""
    for extension in MESHES:
        size = None
        target = new_target("out" + extension)
        done = run("build", "p.csv", target, "--overwrite", "-q")
        if done.returncode == 0:
            size = os.path.getsize(target)
        for length in (1, 100, 4096, size // 2, size - 1):
            target = new_target("out" + extension)
            done = run("build", "p.csv", target, "--overwrite", "-q",
                       preexec_fn=limited(resource.RLIMIT_FSIZE, length))
            judge(f"short write, {extension}, at five lengths", done, "write-failed", target)
        os.remove(target)
        for beside in pathlib.Path(".").glob("out.*"):
            beside.unlink()


def full_disk():
    """Run by this script again inside a namespace where ./full is a tmpfs."""
    inner = ["unshare", "--mount", "--map-root-user", "--user", sys.executable, SCRIPT, BINARY, "--on-tmpfs"]
    done = subprocess.run(inner, capture_output=True, text=True)
    if done.returncode == 77:
        print("skip full disk: no tmpfs can be mounted here")
        return
    if done.returncode != 0:
        faults.append("full disk: " + done.stderr)
        return
    answers = json.loads(done.stdout.splitlines()[-1])
    rows.extend(map(tuple, answers["rows"]))
    faults.extend(answers["faults"])


def fill(path):
    try:
        with open(path, "wb", buffering=0) as file:
            while True:
                file.write(bytes(4096))
    except OSError:
        pass


def on_tmpfs():
    os.mkdir("full")
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=96k", "tmpfs", "full"], capture_output=True).returncode:
        return 77
    for extension in MESHES:
        target = new_target("full/out" + extension)
        done = run("build", "big.csv", target, "--overwrite", "-q")
        judge(f"full disk, {extension}", done, "write-failed", target, "full")
        os.remove(target)
    for option, name in (("--report", "r.json"), ("--picture", "p.png"), ("--proof", "p.proof"),
                         ("--dump-problem", "p.cfn")):
        target, tin = new_target("full/" + name), new_target()
        fill("full/fill")
        done = run("build", "p.csv", tin, option, target, "--overwrite", "-q")
        os.remove("full/fill")
        judge(f"full disk, {option}, the TIN on another", done, "write-failed", tin)
        judge(f"full disk, {option}", done, "write-failed", target, "full")
        os.remove(target)
    print(json.dumps({"rows": rows, "faults": faults}))
    return 0


def full_stdout():
    with open("/dev/full", "w") as full:
        target = new_target()
        done = subprocess.run([BINARY, "build", "p.csv", target, "--overwrite", "--report", "-"], stdout=full,
                              stderr=subprocess.PIPE)
        judge("full disk, report on stdout", done, "write-failed", target)


def as_nobody():
    os.setgid(65534)
    os.setuid(65534)


def forbidden_folder():
    os.mkdir("locked")
    os.chmod("locked", 0o755)
    target = new_target("locked/out.ply")
    done = run("build", "p.csv", target, "--overwrite", "-q", preexec_fn=as_nobody)
    judge("folder cannot be written", done, "write-failed", target, "locked")


def during_a_run(output, change):
    """The finished run, with CHANGE made after its checks before the work and before its source has told anything."""
    os.mkfifo("slow.csv")
    child = subprocess.Popen([BINARY, "build", "slow.csv", output, "-q"], stderr=subprocess.PIPE)
    with open("slow.csv", "wb") as pipe:  # opens when the program does
        change()
        pipe.write(pathlib.Path("p.csv").read_bytes())
    _, err = child.communicate()
    os.remove("slow.csv")
    return subprocess.CompletedProcess([], child.returncode, b"", err)


def folder_goes():
    os.mkdir("gone")
    done = during_a_run("gone/out.ply", lambda: shutil.rmtree("gone"))
    judge("folder is removed during the run", done, "write-failed or not-found")


def output_appears():
    """Another program makes the file during the run: it is not replaced unless that was asked for."""
    done = during_a_run("late.ply", lambda: new_target("late.ply"))
    judge("output appears during the run", done, "output-exists", "late.ply")


# --- sources

def unreadable():
    os.chmod("p.csv", 0)
    os.chmod(".", 0o777)
    target = new_target()
    os.chmod(target, 0o666)
    judge("source may not be read", run("build", "p.csv", target, "--overwrite", "-q", preexec_fn=as_nobody),
          "unreadable", target)
    os.chmod("p.csv", 0o644)


def failing_device():
    os.symlink("/proc/self/mem", "broken.csv")
    target = new_target()
    judge("device fails while the source is read", run("build", "broken.csv", target, "--overwrite", "-q"),
          "unreadable", target)


def folder_as_source():
    os.makedirs("folder.csv", exist_ok=True)
    target = new_target()
    judge("source is a folder", run("build", "folder.csv", target, "--overwrite", "-q"), "unreadable", target)


def changed_while_read(change, label, expected):
    shutil.copy("big.csv", "copy.csv")
    target = new_target()
    child = subprocess.Popen([BINARY, "build", "copy.csv", target, "--overwrite", "-q"], stderr=subprocess.PIPE)
    time.sleep(0.03)
    change()
    _, err = child.communicate()
    judge(label, subprocess.CompletedProcess([], child.returncode, b"", err), expected, target)


def removed_while_read():
    changed_while_read(lambda: os.remove("copy.csv"), "source is removed while it is read", "done or not-found")


def cut_while_read():
    changed_while_read(lambda: os.truncate("copy.csv", 1000001), "source is cut while it is read",
                       "done or bad-format or unreadable")


def pipe_breaks():
    os.mkfifo("pipe.csv")
    target = new_target()

    def write():
        with open("pipe.csv", "wb") as pipe:
            pipe.write(pathlib.Path("p.csv").read_bytes()[:2001])

    writer = threading.Thread(target=write, daemon=True)
    writer.start()
    judge("pipe as source ends in the middle of a row", run("build", "pipe.csv", target, "--overwrite", "-q"),
          "bad-format or missing-height or unreadable", target)


# --- memory, descriptors, threads

def under_limit(label, limit, source, expected):
    """Not tried where the program cannot even say its version under the limit."""
    if run("--version", preexec_fn=limit).returncode == 0:
        target = new_target("out.gpkg")
        judge(label, run("build", source, target, "--overwrite", "-q", preexec_fn=limit), expected, target)


def little_memory():
    for mebibytes in (180, 200, 220, 250, 300):
        under_limit(f"ulimit -v of {mebibytes} MiB", limited(resource.RLIMIT_AS, mebibytes << 20), "big.csv",
                    "out-of-memory or done")


def few_descriptors():
    # The sanitizer looks at memory through a pipe, and takes it for none where it gets no pipe.
    for count in (8,) if "UBSAN_OPTIONS" in os.environ else (5, 8):
        under_limit(f"ulimit -n of {count}", limited(resource.RLIMIT_NOFILE, count), "p.csv",
                    "write-failed or unreadable or not-found or done")


def small_stack():
    under_limit("ulimit -s of 256 KiB", limited(resource.RLIMIT_STACK, 256 << 10), "p.csv", "done or out-of-memory")


# --- signals

def signals():
    begin = time.monotonic()
    run("build", "big.csv", new_target(), "--overwrite", "-q")
    length = time.monotonic() - begin
    moments = random.Random(time.time_ns())
    for number, expected in ((signal.SIGINT, "cancelled or done"), (signal.SIGTERM, "cancelled or done")):
        for _ in range(4):
            target = new_target()
            child = subprocess.Popen([BINARY, "build", "big.csv", target, "--overwrite", "-q"], stderr=subprocess.PIPE)
            time.sleep(moments.random() * length)
            child.send_signal(number)
            _, err = child.communicate()
            if child.returncode == -number:  # it came before the program could hear it
                rows.append((number.name, "none", "the old file"))
                if pathlib.Path(target).read_bytes() != OLD or list(pathlib.Path(".").glob(".thalweg-*")):
                    faults.append(f"{number.name} at the start leaves something")
                continue
            judge(f"{number.name}", subprocess.CompletedProcess([], child.returncode, b"", err), expected, target)
    for _ in range(6):
        target = new_target()
        child = subprocess.Popen([BINARY, "build", "big.csv", target, "--overwrite", "-q"], stderr=subprocess.PIPE)
        time.sleep(moments.random() * 1.2 * length)
        child.kill()
        child.communicate()
        content = pathlib.Path(target).read_bytes()
        disk = "the old file" if content == OLD else "the new file" if whole(target) else "NEITHER OLD NOR NEW"
        remains = list(pathlib.Path(".").glob(".thalweg-*"))
        for remain in remains:
            remain.unlink()
        rows.append(("SIGKILL", "none" if child.returncode < 0 else "done",
                     disk + (", and a hidden file .thalweg-*" if remains else "")))
        if "NEITHER" in disk:
            faults.append("SIGKILL: the target is torn")


def table():
    merged = {}
    for fault, got, disk in rows:
        merged.setdefault((fault, got, disk), 0)
        merged[fault, got, disk] += 1
    print("| fault | answer | on disk afterwards |\n|---|---|---|")
    for (fault, got, disk), count in merged.items():
        times = f" ({count} times)" if count > 1 else ""
        print(f"| {fault}{times} | {got} | {disk} |")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o777)
        os.chdir(folder)
        write_points("p.csv", 400)
        write_points("big.csv", 60000)
        tests = [short_writes, full_disk, full_stdout, folder_goes, output_appears, failing_device, folder_as_source,
                 removed_while_read, cut_while_read, pipe_breaks, little_memory, few_descriptors, small_stack, signals]
        if os.getuid() == 0:
            tests += [forbidden_folder, unreadable]
        for test in tests:
            test()
        os.chdir("/")
    table()
    print("\n".join(faults) or "every fault was answered")
    return 1 if faults else 0


if __name__ == "__main__":
    if sys.argv[2:] == ["--on-tmpfs"]:
        sys.exit(on_tmpfs())
    sys.exit(main())
