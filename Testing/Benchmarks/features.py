#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures and writes the table of sharp edges on the page of MeshParameterization.

usage: features.py PROGRAM MESHES [--write PAGE] [--repeat N]

Runs `knotwork features MESH --output O.vtp --report R.json --threads 1` on cubes, on meshes of a folder (libcgal-demo's) and on both
with noise: normally distributed, of every coordinate, of a share of the diagonal as deviation, numpy.random.default_rng(1). --write puts
the table between the comments `features meshes: begin` and `...: end` of the page. Seconds are those of the report, of N runs the least.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy

import page_tables

CUBES = [(20, (0.002,)), (40, (0.0, 0.002))]
MESHES = [(name, (0.0, 0.0001)) for name in
          ("cross", "joint", "anchor", "rotor", "spool", "part", "pinion", "fandisk", "couplingdown")]
SCANS = [(name, (0.0,)) for name in ("elephant", "bear")]


def cube(n):
    """Six faces of n x n squares of two triangles."""
    triangles, numbers = [], {}
    for face in range(6):
        axis, upper = divmod(face, 2)
        for i in range(n):
            for j in range(n):
                corners = []
                for u, v in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                    place = [0, 0, 0]
                    place[axis] = n * upper
                    place[(axis + 1) % 3], place[(axis + 2) % 3] = (u, v) if upper else (v, u)
                    corners.append(numbers.setdefault(tuple(place), len(numbers)))
                triangles += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
    return numpy.array(list(numbers), float) / n, triangles


def read(file):
    """Points and faces of an OFF file."""
    words = " ".join(line.split("#")[0] for line in file.read_text().splitlines()).split()
    count, faces = int(words[1]), int(words[2])
    points = numpy.array(words[4:4 + 3 * count], float).reshape(count, 3)
    corners, at = [], 4 + 3 * count
    for _ in range(faces):
        size = int(words[at])
        corners.append(tuple(map(int, words[at + 1:at + 1 + size])))
        at += 1 + size
    return points, corners


def features(program, points, faces, folder, repeat):
    """The report of the fastest run, with the "triangles"."""
    mesh, report = folder / "mesh.off", folder / "report.json"
    with open(mesh, "w") as stream:
        stream.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        stream.writelines("{:.17g} {:.17g} {:.17g}\n".format(*point) for point in points)
        stream.writelines(" ".join(map(str, (len(face), *face))) + "\n" for face in faces)
    runs = []
    for _ in range(repeat):
        subprocess.run([program, "features", str(mesh), "--output", str(folder / "regions.vtp"), "--report", str(report), "--threads", "1",
                        "--quiet"], check=True)
        runs.append(json.loads(report.read_text()))
    said = min(runs, key=lambda run: run["seconds"])
    said["triangles"] = sum(len(face) - 2 for face in faces)
    return said


def rows(program, meshes, folder, repeat):
    yield "| mesh | triangles | edges | chains | corners | regions | noise / diagonal | s |"
    yield "| --- | --- | --- | --- | --- | --- | --- | --- |"
    cases = [(f"cube, n = {n}", cube(n), noises) for n, noises in CUBES]
    cases += [(f"`{name}.off`", read(meshes / f"{name}.off"), noises) for name, noises in MESHES + SCANS]
    for words, (points, faces), noises in cases:
        diagonal = float(numpy.linalg.norm(numpy.ptp(points, axis=0)))
        for noise in noises:
            moved = points + numpy.random.default_rng(1).normal(0.0, 1.0, points.shape) * noise * diagonal
            said = features(program, moved, faces, folder, repeat)
            level = said["noise_level"] / diagonal
            level = "0" if level < 1e-10 else f"{level:.0e}" if level < 1e-5 else f"{level:.1e}"
            name = f"{words}, noisy ({100.0 * noise:.2g} %)" if noise else words
            numbers = " | ".join(str(said[key]) for key in ("triangles", "sharp_edges", "chains", "corners", "regions"))
            yield f"| {name} | {numbers} | {level.replace('e-0', 'e-')} | {said['seconds']:.2g} |"


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("--write", type=pathlib.Path)
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        lines = list(rows(arguments.program, arguments.meshes, pathlib.Path(folder), arguments.repeat))
    print("\n".join(lines))
    if arguments.write:
        page_tables.write_table(arguments.write, "features meshes", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(main())
