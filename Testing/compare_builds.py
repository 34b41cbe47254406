#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Whether two builds of the program do the same: every run of every job on the tests' small inputs, on the files of Testing/Data and on
standard shapes, with both; outputs must agree bit for bit, reports but for times and memory, messages and exit status as they are.

usage: compare_builds.py OLD NEW    (build folders; needs Python's VTK of the second build's path, as the tests do)
For changes that change no result: run it before they are landed. Prints what differs; exit status 1 where anything does."""
import filecmp
import json
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
OLD, NEW = map(os.path.abspath, sys.argv[1:3])
WORK = tempfile.TemporaryDirectory()
os.environ.update(KNOTWORK_DATA_DIR=os.path.join(HERE, "Data"), KNOTWORK_BASELINE_DIR=os.path.join(HERE, "Baseline"),
                  KNOTWORK_OUTPUT_DIR=WORK.name, KNOTWORK_BIN_DIR=os.path.join(OLD, "bin"))
sys.path[:0] = [os.path.join(HERE, "Harness"), os.path.join(HERE, "..", "Modules", "CommandLine", "Testing")]

import job_inputs  # noqa: E402  (it asks for the folders above)

MEASURED = re.compile(r"seconds|peak_(own_)?bytes")  # keys of a report that differ from run to run
SHAPES = ("square", "cube", "annulus-sector", "ball-sector", "twisted-bar", "solid-torus")


def all_runs():
    """Arguments of the runs; outputs have names without a folder."""
    job_inputs.make_files()
    for arguments, kind in job_inputs.runs():
        for ending in job_inputs.ENDINGS[kind]:
            if os.path.exists(job_inputs.sound(kind, ending)):
                yield job_inputs.on(arguments, job_inputs.sound(kind, ending))
    for shape in SHAPES:
        yield ["source", "--shape", shape, "--output", "shape.vtu", "--report", "report.json"]
    for folder, _, names in os.walk(os.environ["KNOTWORK_DATA_DIR"]):
        for name in sorted(names):
            file = os.path.join(folder, name)
            if not name.endswith(".md"):
                yield ["info", file]
                for ending in ("vtu", "vtpc", "step", "xml", "g2"):
                    yield ["convert", file, "--output", "out." + ending, "--report", "report.json"]
                yield ["tessellate", file, "--output", "out.vtp", "--report", "report.json"]
                yield ["validate", file, "--output", "out.vtu", "--report", "report.json"]


def outcome(build, arguments, folder):
    done = subprocess.run([os.path.join(build, "bin", "knotwork"), *map(str, arguments)], cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=600)
    return done.returncode, done.stdout, done.stderr.replace(build.encode(), b"")


def report_of(file):
    with open(file) as stream:
        return {key: value for key, value in json.load(stream).items() if not MEASURED.search(key)}


def differences(arguments):
    with tempfile.TemporaryDirectory() as old, tempfile.TemporaryDirectory() as new:
        before, after = outcome(OLD, arguments, old), outcome(NEW, arguments, new)
        if before != after:
            yield f"{before} became {after}"
        files = [sorted(os.path.relpath(os.path.join(path, name), folder) for path, _, names in os.walk(folder) for name in names)
                 for folder in (old, new)]
        if files[0] != files[1]:
            yield f"files {files[0]} became {files[1]}"
        for name in set(files[0]) & set(files[1]):
            pair = os.path.join(old, name), os.path.join(new, name)
            if name == "report.json":
                reports = [report_of(file) for file in pair]
                for key in reports[0].keys() | reports[1].keys():
                    if reports[0].get(key) != reports[1].get(key):
                        yield f"report: {key}: {reports[0].get(key)} became {reports[1].get(key)}"
            elif not filecmp.cmp(*pair, shallow=False):
                yield f"{name} differs"


count, different = 0, 0
for run in all_runs():
    count += 1
    found = list(differences(run))
    different += bool(found)
    for line in found:
        print("knotwork", *run, ":", line)
print(f"{count} runs, {different} differ")
sys.exit(1 if different or not count else 0)
