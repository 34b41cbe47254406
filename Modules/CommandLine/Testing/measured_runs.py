# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the program with what they cost, and what is wrong with what they wrote."""
import os
import re
import subprocess
import time

import knotwork_testing

# what only those who wrote VTK or OpenCASCADE can read
INTERNALS = re.compile(r"0x[0-9a-f]{6,}|\bvtk[A-Z]\w* ?\((?:0x|nil|\(nil)|ERROR: In|\.cxx\b|, line \d+ of file|Standard_|\(null\)|std::|basic_string|\bvtk\w+::|Reference Count|Process continues|Unknown message|parameter %d")


def run(arguments, folder, most_seconds):
    """Exit status (negative: a signal), seconds, of those of the processors, largest memory of the program and its children, and stderr."""
    with open(os.path.join(folder, "stderr"), "w+b") as errors:
        begin = time.monotonic()
        process = subprocess.Popen([knotwork_testing.PROGRAM, *map(str, arguments)], cwd=folder, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=errors)
        while True:  # wait4 tells the memory, but has no limit of time
            done, status, usage = os.wait4(process.pid, os.WNOHANG)
            seconds = time.monotonic() - begin
            if done:
                break
            if seconds > most_seconds:
                process.kill()
            time.sleep(0.005)
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        return process.returncode, seconds, usage.ru_utime + usage.ru_stime, 1024 * usage.ru_maxrss, errors.read()


def faults_of_message(name, status, errors):
    """What is not as it should be in what a job wrote to stderr; of a failure that is one line, and it names the file."""
    try:
        text = errors.decode()
    except UnicodeDecodeError:
        yield "wrote what is no UTF-8"
        return
    if re.search(r"[^\n\x20-\x7e\u00a0-\U0010ffff]", text):
        yield "wrote control characters"
    if INTERNALS.search(text):
        yield "wrote internals"
    if status == 1:
        if text.count("\n") != 1 or not text.endswith("\n"):
            yield "did not write one line"
        if name not in text:
            yield "does not name the file"
        if len(text) > 2500:
            yield "wrote too much"
