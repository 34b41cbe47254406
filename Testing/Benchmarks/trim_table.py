# SPDX-License-Identifier: BSD-3-Clause
"""The table of whole runs on the page of surface trimming: `knotwork trim MESH --output FACE.step --features off --threads 1` on meshes of
Debian's libcgal-demo, and on a folder of scans when one is given.

usage: trim_table.py PROGRAM [--scans FOLDER] [--write PAGE]

--write puts the table between the comments `the table of whole runs: begin` and `end` of a page. Deviations are shares of the
diagonal; "edges" is the largest tolerance of an edge or vertex in the file read again, as a share of the tolerance asked for.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tarfile
import tempfile

import page_tables

ARCHIVE = "/usr/share/doc/libcgal-dev/data.tar.gz"
PATCHES = [f"patch-{k}.off" for k in ("01", "13", "20", "21", "23", "30")]
SCANS = ["beetle.off", "maskgen_3k.off", "plane_27holes.obj", "half_glove_a.off", "scone_2k.off"]
HEAD = ["mesh", "triangles", "flattening", "faces", "loops", "net", "max deviation", "rms", "area", "edges", "|S_u x S_v| above",
        "proved", "CPU s"]


def diagonal(mesh):
    """Of the box of an OFF or OBJ file."""
    with open(mesh) as stream:
        words = [line.split("#")[0].split() for line in stream]
    words = [line for line in words if line]
    if mesh.endswith(".obj"):
        points = [[float(x) for x in line[1:4]] for line in words if line[0] == "v"]
    else:
        numbers = [word for line in words for word in line][1:]
        count = int(numbers[0])
        points = [[float(x) for x in numbers[3 + 3 * i:6 + 3 * i]] for i in range(count)]
    return math.dist([min(p[d] for p in points) for d in range(3)], [max(p[d] for p in points) for d in range(3)])


def measured(program, mesh, folder):
    """A row of the table, or what the program says."""
    report = os.path.join(folder, "report.json")
    done = subprocess.run([program, "trim", mesh, "--output", os.path.join(folder, "face.step"), "--features", "off",
                           "--report", report, "--threads", "1"],
                          stderr=subprocess.PIPE, text=True)
    name = os.path.splitext(os.path.basename(mesh))[0]
    if done.returncode != 0:
        return [name, done.stderr.strip()] + [""] * (len(HEAD) - 2)
    with open(report) as stream:
        said = json.load(stream)
    size = diagonal(mesh)
    percent = lambda x: f"{100 * x:.2g} %"  # noqa: E731
    proved = [word for word, holds in (("tolerance", said["within_tolerance"]), ("loops", said["loops_proved"]),
                                       ("normals", said["verdict"] == "valid"), ("B-rep", said["brep_valid"])) if holds]
    edges = max(said["max_edge_tolerance"], said["max_vertex_tolerance"]) / said["tolerance"]
    nets = said["nets"].split(", ")
    return [name, str(said["triangles"]), said["flatten_method"], str(said["faces"]), str(said["loops"]),
            nets[0] if len(nets) == 1 else f"{said['control_points']} points", percent(said["max_deviation"] / size),
            percent(said["rms_deviation"] / size), f"{100 * (said['area'] / said['mesh_area'] - 1):+.2g} %", f"{edges:.2g}",
            f"{said['min_normal_bound']:.2g}", "all" if len(proved) == 4 else ", ".join(proved), f"{said['cpu_seconds']:.2g}"]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--scans")
    parser.add_argument("--write")
    arguments = parser.parse_args()
    rows = [HEAD]
    if not os.path.exists(ARCHIVE):
        sys.exit(f"{ARCHIVE} is missing; install the package libcgal-demo")
    with tempfile.TemporaryDirectory() as folder:
        meshes = []
        with tarfile.open(ARCHIVE) as archive:
            for name in PATCHES:
                meshes.append(os.path.join(folder, name))
                with open(meshes[-1], "wb") as stream:
                    stream.write(archive.extractfile("data/meshes/" + name).read())
        scans = [os.path.join(arguments.scans or "", name) for name in SCANS]
        present = [scan for scan in scans if arguments.scans and os.path.exists(scan)]
        if len(present) < len(scans):
            print(f"{len(scans) - len(present)} scans are not there and left out", file=sys.stderr)
        for mesh in present + meshes:
            rows.append(measured(arguments.program, mesh, folder))
            print(" | ".join(rows[-1]), file=sys.stderr)
    table = page_tables.table_text(rows[0], rows[1:])
    print(table, end="")
    if arguments.write:
        page_tables.write_table(arguments.write, "the table of whole runs", table)


if __name__ == "__main__":
    main()
