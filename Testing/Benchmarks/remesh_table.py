# SPDX-License-Identifier: BSD-3-Clause
"""The table of remeshing on the page of surface remeshing: `knotwork remesh MESH --output OUT.vtp --report OUT.json --threads 1` on meshes of
Debian's libcgal-demo, with its defaults and with --sizing curvature.

usage: remesh_table.py PROGRAM [--only NAME ...] [--write PAGE]

--write puts the table between the comments `the table of remeshing: begin` and `end` of a page. Distances are shares of the diagonal.
"""
import argparse
import json
import os
import subprocess
import sys
import tarfile
import tempfile

import page_tables
from repair_table import ARCHIVE, FOLDER, LIMIT, shortened

NAMES = ("anchor_dense bear blade blobby bones cactus couplingdown cow cube-ouvert double-torus-3-holes dragknob eight elephant ellipsoid fandisk femur hand handle "
         "helmet homer joint knot1 mpi_triang part pinion_small pipe rotor spool u").split()
HEAD = ["mesh", "options", "triangles", "Euler number", "least angle", "fitting edges", "intersections", "from the input", "to the input", "s"]


def row(program, name, mesh, options, folder):
    output, report = os.path.join(folder, "out.vtp"), os.path.join(folder, "out.json")
    first = [name, " ".join(options)]
    try:
        done = subprocess.run([program, "remesh", mesh, *options, "--output", output, "--report", report, "--threads", "1", "--force"],
                              stderr=subprocess.PIPE, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return first + [f"not done after {LIMIT} s"] + [""] * (len(HEAD) - 3)
    if done.returncode != 0:
        return first + [shortened(done.stderr, mesh).replace("knotwork remesh: ", "")] + [""] * (len(HEAD) - 3)
    with open(report, encoding="utf-8") as stream:
        said = json.load(stream)

    def both(key, form):
        return " to ".join(form.format(said[key + end]) for end in ("_before", "_after"))

    euler = str(said["euler_after"]) if said["euler_before"] == said["euler_after"] else both("euler", "{}")
    return first + [both("triangles", "{}"), euler, both("least_angle", "{:.1f}"), f"{said['fitting_edges']:.2f}", str(said["intersections"]),
                    *(f"{said[key] / said['diagonal']:.1e}" for key in ("distance_from_input", "distance_to_input")), f"{said['seconds']:.1f}"]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--only", nargs="*", default=NAMES)
    parser.add_argument("--write")
    arguments = parser.parse_args()
    if not os.path.exists(ARCHIVE):
        sys.exit(f"{ARCHIVE} is missing; install the package libcgal-demo")
    rows = []
    with tempfile.TemporaryDirectory() as folder, tarfile.open(ARCHIVE) as archive:
        for name in arguments.only:
            mesh = os.path.join(folder, name + ".off")
            with open(mesh, "wb") as stream:
                stream.write(archive.extractfile(f"{FOLDER}{name}.off").read())
            for options in ([], ["--sizing", "curvature"]):
                rows.append(row(arguments.program, name, mesh, options, folder))
                print(" | ".join(rows[-1]), file=sys.stderr, flush=True)
    table = page_tables.table_text(HEAD, rows)
    print(table, end="")
    if arguments.write:
        page_tables.write_table(arguments.write, "the table of remeshing", table)


if __name__ == "__main__":
    main()
