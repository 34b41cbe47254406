#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures how many faces keep their type when a part's mesh gets noise, or fewer triangles.

usage: changed_parts.py PROGRAM MESHES [--parts NAME,...] [--write PAGE]

Runs `knotwork trim MESH --output O.step --report R.json --threads 1` on meshes of a folder (libcgal-demo's) as they are; with noise,
points of a ball of a quarter of the tolerance (numpy.random.default_rng(1)); and with as few triangles as vtkQuadricDecimation and
vtkDecimatePro leave while `knotwork distance --both-ways` finds half of the tolerance at most. The tolerance is that of the whole mesh.
Faces that keep their type: of each type as many as both models have. --parts: only these. --write puts the table between the comments
`changed parts: begin` and `...: end` of the page.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import features
import page_tables

PARTS = ("joint", "anchor", "rotor", "spool", "cross", "part", "couplingdown", "pinion", "fandisk")
TYPES = ("planes", "cylinders", "spheres", "cones", "tori", "extrusions", "revolutions", "free_faces")
HEAD = ("mesh", "points", "triangles", "distance / tolerance", "planes, cylinders, spheres, cones, tori, extrusions, revolutions, free form", "same type",
        "control points", "valid solid")


class Program:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, *arguments):
        report = self.folder / "report.json"
        subprocess.run([self.program, *map(str, arguments), "--force", "--quiet", "--threads", "1", "--report", report], check=True)
        return json.loads(report.read_text())

    def write(self, name, points, triangles):
        mesh = self.folder / name
        with open(mesh, "w") as stream:
            stream.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
            stream.writelines("%.17g %.17g %.17g\n" % tuple(p) for p in points)
            stream.writelines("3 %d %d %d\n" % tuple(t) for t in triangles)
        return mesh

    def trim(self, mesh, tolerance):
        return self.run("trim", mesh, "--output", self.folder / "model.step", "--tolerance", repr(tolerance))

    def distance(self, mesh, other):
        said = self.run("distance", mesh, other, "--both-ways", "1", "--output", self.folder / "distance.vtp")
        return max(abs(said[key]) for key in ("scan_min", "scan_max", "model_min", "model_max"))


def decimated(points, triangles, kind, reduction):
    cells = vtk.vtkCellArray()
    for t in triangles:
        cells.InsertNextCell(3, [int(p) for p in t])
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    mesh = vtk.vtkPolyData()
    mesh.SetPoints(places)
    mesh.SetPolys(cells)
    decimation = kind()
    decimation.SetInputData(mesh)
    decimation.SetTargetReduction(reduction)
    if kind is vtk.vtkDecimatePro:
        decimation.PreserveTopologyOn()
        decimation.SplittingOff()
        decimation.SetFeatureAngle(5.0)
    decimation.Update()
    result = decimation.GetOutput()
    return vtk_to_numpy(result.GetPoints().GetData()).astype(float), vtk_to_numpy(result.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def coarsest(program, whole, points, triangles, kind, largest):
    """The mesh with the fewest triangles found by bisection, and its distance; nothing when there is none."""
    lower, upper, found = 0.0, 0.97, None
    for _ in range(8):
        middle = 0.5 * (lower + upper)
        coarse = decimated(points, triangles, kind, middle)
        distance = program.distance(program.write("coarse.off", *coarse), whole)
        if distance <= largest:
            lower, found = middle, (*coarse, distance)
        else:
            upper = middle
    return found


def rows_of(program, name, points, triangles):
    tolerance = 1e-3 * float(numpy.linalg.norm(points.max(0) - points.min(0)))
    whole = program.write("whole.off", points, triangles)
    exact = program.trim(whole, tolerance)

    def row(what, count, distance, said):
        same = sum(min(said[t], exact[t]) for t in TYPES)
        faces = sum(exact[t] for t in TYPES)
        return ([name, what, str(count), distance, ", ".join(str(said[t]) for t in TYPES), f"{same} of {faces}",
                 str(said["control_points"]), "yes" if said["brep_valid"] and said["within_tolerance"] else "no"], same, faces)

    yield row("exact", len(triangles), "0", exact)
    random = numpy.random.default_rng(1)
    direction = random.normal(size=points.shape)
    radius = 0.25 * tolerance * random.uniform(size=(len(points), 1)) ** (1 / 3)
    noisy = points + radius * direction / numpy.linalg.norm(direction, axis=1)[:, None]
    yield row("noise", len(triangles), "0.25", program.trim(program.write("noisy.off", noisy, triangles), tolerance))
    for what, kind in (("quadric decimation", vtk.vtkQuadricDecimation), ("subset of the points", vtk.vtkDecimatePro)):
        coarse = coarsest(program, whole, points, triangles, kind, 0.5 * tolerance)
        if coarse:
            said = program.trim(program.write("coarse.off", *coarse[:2]), tolerance)
            yield row(what, len(coarse[1]), f"{coarse[2] / tolerance:.2f}", said)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("--parts", default=",".join(PARTS))
    parser.add_argument("--write", type=pathlib.Path)
    arguments = parser.parse_args()
    lines = ["| " + " | ".join(HEAD) + " |", "|" + " --- |" * len(HEAD)]
    sums = {}
    with tempfile.TemporaryDirectory() as folder:
        program = Program(arguments.program, pathlib.Path(folder))
        for name in arguments.parts.split(","):
            points, faces = features.read(arguments.meshes / (name + ".off"))
            triangles = [(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)]
            for row, same, count in rows_of(program, name, points, triangles):
                lines.append("| " + " | ".join(row) + " |")
                sums.setdefault(row[1], []).append((same, count))
    for what, all_parts in sums.items():
        same, count = (sum(pair[i] for pair in all_parts) for i in (0, 1))
        lines.append(f"| all | {what} | | | | {same} of {count} ({100 * same / count:.0f} %) | | |")
    table = "\n".join(lines)
    print(table)
    if arguments.write:
        page_tables.write_table(arguments.write, "changed parts", table)


if __name__ == "__main__":
    main()
