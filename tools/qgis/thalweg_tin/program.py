"""Runs the program: finds it, hands on its progress and messages, stops it on cancel."""

import os
import queue
import re
import shutil
import subprocess
import threading

from processing.core.ProcessingConfig import ProcessingConfig
from qgis.core import QgsProcessingException

SETTING = "THALWEG_PROGRAM"
_REMEDY = "Install thalweg, or name it under Settings, Options, Processing, Providers, Thalweg."


def find_program():
    """The path of thalweg: the setting, else the variable THALWEG_PROGRAM, else what PATH finds."""
    path = ProcessingConfig.getSetting(SETTING) or os.environ.get("THALWEG_PROGRAM") or shutil.which("thalweg")
    if not path:
        raise QgsProcessingException(f"The program thalweg was not found. {_REMEDY}")
    return path


def _start(command):
    quiet = {"creationflags": subprocess.CREATE_NO_WINDOW} if os.name == "nt" else {}
    try:
        return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                **quiet)
    except OSError as error:
        raise QgsProcessingException(f"The program {command[0]} cannot be run: {error.strerror}. {_REMEDY}") from error


def _read(stream, into, size):
    """Puts what a pipe gives into a queue, then None."""
    while True:
        data = stream.read1(size)
        into.put(data)
        if not data:
            return


class _Progress:
    """Reads lines like `triangulate  0...10...20` and tells feedback about them, a phase as soon as it starts."""

    PHASE = re.compile(r"([\w -]+?) +0(?:\.\.\.|\.{0,2}$)")

    def __init__(self, feedback):
        self.feedback = feedback
        self.line = ""
        self.in_phase = False
        self.errors = []

    def feed(self, text):
        for part in re.split(r"(\n)", text):
            if part == "\n":
                self.end_line()
                continue
            self.line += part
            phase = None if self.in_phase else self.PHASE.match(self.line)
            if phase:
                self.in_phase = True
                self.feedback.setProgressText(phase.group(1))
            numbers = re.findall(r"\d+(?=\.\.\.| - done)", self.line)
            if numbers:
                self.feedback.setProgress(min(100, int(numbers[-1])))

    def end_line(self):
        if self.line.startswith("ERROR "):
            self.errors.append(self.line[len("ERROR "):])
        elif self.line.strip() and not self.in_phase:
            self.feedback.pushInfo(self.line)
        self.line = ""
        self.in_phase = False


def run(arguments, feedback):
    """Runs `thalweg ARGUMENTS` and returns what it printed.

    The program is asked to stop as soon as feedback is cancelled; it leaves no file then, unless it was done before.
    A failure is a QgsProcessingException with the program's own message.
    """
    command = [find_program(), *arguments]
    feedback.pushCommandInfo(" ".join(f"'{a}'" if " " in a or "|" in a else a for a in command))
    process = _start(command)
    out, err = queue.Queue(), queue.Queue()
    threads = [threading.Thread(target=_read, args=(process.stdout, out, 65536), daemon=True),
               threading.Thread(target=_read, args=(process.stderr, err, 4096), daemon=True)]
    for thread in threads:
        thread.start()
    progress = _Progress(feedback)
    stopped = False
    while True:
        try:
            data = err.get(timeout=0.1)
        except queue.Empty:
            data = b"\0"
        if not data:
            break
        progress.feed(data.decode(errors="replace").replace("\0", ""))
        if feedback.isCanceled() and not stopped:
            process.terminate()
            stopped = True
    progress.end_line()
    for thread in threads:
        thread.join()
    process.stdout.close()
    process.stderr.close()
    status = process.wait()
    text = b"".join(iter(out.get, b"")).decode(errors="replace")
    if status != 0 and stopped:
        raise QgsProcessingException("Stopped; no output was left.")
    if status != 0:
        raise QgsProcessingException("\n".join(progress.errors) or f"thalweg ended with status {status}")
    for line in text.splitlines():
        feedback.pushInfo(line)
    return text
