# SPDX-License-Identifier: BSD-3-Clause
"""The table of repairs on the page of surface remeshing: `knotwork repair MESH --output OUT.vtp --report OUT.json --threads 1` on all meshes
of Debian's libcgal-demo.

usage: repair_table.py PROGRAM [--only NAME ...] [--keep FOLDER] [--write PAGE]

Open meshes are run a second time with --largest-hole 1, and a third time with --allow-open when that is refused too. What was repaired is
repaired once more: a second repair must leave it as it is. --write puts the table between the comments `the table of repairs: begin` and
`end` of a page; meshes that came back as they are, are listed below it. Distances are shares of the diagonal.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
import time

import page_tables

ARCHIVE = "/usr/share/doc/libcgal-dev/data.tar.gz"
FOLDER = "data/meshes/"
LIMIT = 120  # seconds a run
PART_LEFT_OUT = 5
HEAD = ["mesh", "triangles", "options", "outcome", "actions", "Euler number", "from the input", "to the input", "s"]
ACTIONS = ["merged_points", "degenerate_faces", "duplicate_faces", "loose_faces", "turned_faces", "junctions", "holes", "intersections",
           "divided_edges", "divided_points", "cut_tips", "overlaps", "inner_walls", "small_parts",
           "patches"]


def shortened(error, mesh):
    """An error line without paths, and with its first place only."""
    error = error.strip().replace("\n", " ").replace(f"'{mesh}': ", "").replace("knotwork repair: ", "")
    return re.sub(r"(?:some of them )?at (\([^)]*\))(?:, \([^)]*\))+", r"one at \1", error)


class Run:
    """One run of the job."""

    def __init__(self, program, mesh, stem, options):
        self.output, report = stem + ".vtp", stem + ".json"
        start = time.monotonic()
        try:
            done = subprocess.run([program, "repair", mesh, *options, "--output", self.output, "--report", report, "--threads", "1", "--force"],
                                  stderr=subprocess.PIPE, text=True, timeout=LIMIT)
            self.status, self.error = done.returncode, shortened(done.stderr, mesh)
        except subprocess.TimeoutExpired:
            self.status, self.error = None, f"not done after {LIMIT} s"
        self.seconds = time.monotonic() - start
        self.options = " ".join(option for option in options)
        self.report = {}
        if self.status == PART_LEFT_OUT:
            self.status = 0
        if self.status == 0:
            with open(report, encoding="utf-8") as stream:
                self.report = json.load(stream)

    def outcome(self):
        if self.status != 0:
            return self.error if self.status == 1 else f"**{self.error or 'ended by signal'} ({self.status})**"
        closed = "closed" if self.report["closed"] else "open"
        return f"{closed}, repaired" if self.report["changed"] else f"{closed}, as it was"

    def row(self, name):
        if self.status != 0:
            return [name, "", self.options, self.outcome(), "", "", "", "", f"{self.seconds:.2g}"]
        said = self.report
        actions = [f"{said[key]} {key.replace('_', ' ')}" for key in ACTIONS if said[key]]
        euler = f"{said['euler_before']}" + ("" if said["euler_before"] == said["euler_after"] else f" to {said['euler_after']}")
        share = lambda key: f"{said[key] / said['diagonal']:.1e}" if said[key] else "0"  # noqa: E731
        return [name, str(said["triangles_before"]), self.options, self.outcome(), ", ".join(actions), euler, share("distance_from_input"),
                share("distance_to_input"), f"{self.seconds:.2g}"]


def runs(program, mesh, folder):
    """All runs of a mesh, the last one counts."""
    stem = os.path.join(folder, os.path.basename(mesh))
    for options in ([], ["--largest-hole", "1"], ["--allow-open"]):
        run = Run(program, mesh, stem, options)
        yield run
        if run.status != 1 or (not re.search("holes? stays?,", run.error) and not options):
            break
    if run.status == 0 and run.report["changed"]:
        again = Run(program, run.output, stem + ".again", options[-1:] if options[-1:] == ["--allow-open"] else [])
        if again.status != 0 or again.report["changed"]:
            run.status, run.error = 2, f"a second repair is not without changes: {again.outcome()}"
            yield run


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--only", nargs="*")
    parser.add_argument("--keep")
    parser.add_argument("--write")
    arguments = parser.parse_args()
    if not os.path.exists(ARCHIVE):
        sys.exit(f"{ARCHIVE} is missing; install the package libcgal-demo")
    rows, sound = [], []
    with tempfile.TemporaryDirectory() as folder, tarfile.open(ARCHIVE) as archive:
        for name in sorted(member.name[len(FOLDER):] for member in archive if member.isfile() and member.name.startswith(FOLDER)):
            if arguments.only and os.path.splitext(name)[0] not in arguments.only:
                continue
            mesh = os.path.join(folder, name)
            with open(mesh, "wb") as stream:
                stream.write(archive.extractfile(FOLDER + name).read())
            for run in runs(arguments.program, mesh, arguments.keep or folder):
                row = run.row(name)
                print(" | ".join(row), file=sys.stderr, flush=True)
            if run.status == 0 and not run.report["changed"] and run.report["closed"]:
                sound.append(name)
            else:
                rows.append(row)
    table = page_tables.table_text(HEAD, rows)
    table += f"\n{len(sound)} closed meshes come back as they are: {', '.join(os.path.splitext(name)[0] for name in sound)}.\n"
    print(table, end="")
    if arguments.write:
        page_tables.write_table(arguments.write, "the table of repairs", table)


if __name__ == "__main__":
    main()
