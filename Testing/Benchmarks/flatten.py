#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures and writes the tables of accuracy and charts on the page of MeshParameterization.

usage: flatten.py PROGRAM MESHES [--charts CLOSED] [--only TABLE] [--write PAGE] [--repeat N]

Runs `knotwork flatten MESH --method METHOD --fallback 0 --threads 1 --report` on the meshes of a folder; a file .uv beside a
mesh is its true flattening, one point a line. --write puts the tables between the comments `flatten accuracy: begin`, `...:
end` and `flatten methods: begin`, `...: end` of the page; with the folder CLOSED (libcgal-demo's meshes) also that of charts, of runs with
`--maximum-stretch`. --only: accuracy, methods or charts. Needs the Python that has VTK's modules and NumPy.

RMS is the distance from the true flattening after the best rigid motion over the diagonal of its box. Seconds are those of the
processor for the whole run, reading, measures and writing included; of N runs the fastest. Memory is the largest resident set.
"""
import argparse
import json
import os
import pathlib
import sys
import tempfile

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import page_tables

ACCURACY = [("scone_2k", "S on a cone"), ("scone_10k", "S on a cone"), ("swisshole_3k", "swiss roll with a hole"),
            ("tightroll_6k", "tight roll, layers 1.3 edges apart"), ("maskgen_3k", "face with eyes and mouth (4 loops)"),
            ("maskgen_100k", "the same"), ("beetle", "beetle (11 loops)"), ("half_glove_a", "half of a glove")]
METHODS = [("HLLE", ["hlle"]), ("Isomap", ["isomap"]), ("Isomap, edge graph", ["isomap", "--geodesics", "edge-graph"]),
           ("Laplacian eigenmaps", ["laplacian"]), ("LSCM", ["lscm"]), ("ARAP", ["arap"]), ("Injective", ["injective"])]
CASES = [("scone_2k", "S on a cone"), ("beetle", "beetle"), ("maskgen_3k", "face, 3109 points"),
         ("half_glove_a", "half of a glove")]
CHARTS = [("plane_27holes.obj", "airplane with 27 windows", (3, 1.2)), ("elephant.off", "elephant (closed, 3 handles)", (3,)),
          ("couplingdown.off", "coupling (closed, 9 handles)", (3, 1.5)), ("bear.off", "bear (closed)", (3, 1.5)),
          ("femur.off", "femur (closed, 2 handles)", (3,)), ("half_glove_a.off", "half of a glove", (3,)),
          ("maskgen_100k.off", "face, 100592 points", (3,))]


def flatten(program, mesh, folder, *options):
    """The report of a run, with "uv", "processor_seconds" and "megabytes"."""
    report, output = os.path.join(folder, "report.json"), os.path.join(folder, "uv.vtp")
    command = [program, "flatten", str(mesh), "--threads", "1", "--quiet", "--report", report, "--output", output,
               "--method", *options]
    child = os.posix_spawn(program, command, os.environ)
    _, status, usage = os.wait4(child, 0)
    if status != 0:
        raise RuntimeError(f"{' '.join(command)}: status {status}")
    with open(report) as stream:
        said = json.load(stream)
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(output)
    reader.Update()
    said["uv"] = numpy.array(vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("UV")))
    said["processor_seconds"] = usage.ru_utime + usage.ru_stime
    said["megabytes"] = usage.ru_maxrss / 1024.0
    return said


def distance_from_truth(uv, truth):
    """Root mean square after the best rigid motion, over the diagonal of the truth's box."""
    a, b = uv - uv.mean(axis=0), truth - truth.mean(axis=0)
    left, _, right = numpy.linalg.svd(a.T @ b)
    off = a @ (left @ right) - b
    return float(numpy.sqrt((off ** 2).sum(axis=1).mean()) / numpy.linalg.norm(numpy.ptp(truth, axis=0)))


def truth_of(mesh):
    """The true flattening beside a mesh, or None."""
    file = mesh.with_suffix(".uv")
    return numpy.loadtxt(file) if file.exists() else None


def accuracy(program, meshes, folder, repeat):
    yield "| mesh | points | HLLE flips | RMS | processor seconds | memory |"
    yield "| --- | --- | --- | --- | --- | --- |"
    for name, words in ACCURACY:
        mesh = meshes / f"{name}.off"
        runs = [flatten(program, mesh, folder, "hlle", "--fallback", "0") for _ in range(repeat)]
        truth = truth_of(mesh)
        rms = "-" if truth is None else f"{distance_from_truth(runs[0]['uv'], truth):.1e}".replace("e-0", "e-")
        flips = str(runs[0]["flipped_triangles"])
        if runs[0]["flipped_triangles"] > 0:
            instead = flatten(program, mesh, folder, "hlle")
            flips += f"; with fallback {instead['method']}: {instead['flipped_triangles']}"
        yield (f"| {words} | {runs[0]['points']} | {flips} | {rms} | {min(run['processor_seconds'] for run in runs):.2f} | "
               f"{min(run['megabytes'] for run in runs):.0f} MB |")


def digits(value):
    """A stretch: what it is above 1 in two digits."""
    if value >= 1000:
        return f"{value:.0e}".replace("e+0", "e")
    if value >= 1.1:
        return f"{value:.3g}"
    return f"{value:.2f}" if value >= 1.01 else f"1 + {value - 1:.0e}".replace("e-0", "e-")


def methods(program, meshes, folder, _):
    sizes = {}
    rows = []
    for name, options in METHODS:
        cells = []
        for mesh, _ in CASES:
            said = flatten(program, meshes / f"{mesh}.off", folder, *options, "--fallback", "0")
            sizes[mesh] = said["triangles"]
            flips = said["flipped_triangles"]
            cells.append(f"{f'**{flips}**' if flips > 100 else flips}; {digits(said['mean_stretch'])}, {digits(said['max_stretch'])}")
        rows.append(f"| {name} | " + " | ".join(cells) + " |")
    yield "| method | " + " | ".join(f"{words} ({sizes[mesh]} triangles)" for mesh, words in CASES) + " |"
    yield "| --- |" + " --- |" * len(CASES)
    yield from rows


def charts(program, meshes, closed, folder, repeat):
    yield "| mesh | triangles with cuts | limit | charts | inner loops | methods | stretch | processor seconds |"
    yield "| --- | --- | --- | --- | --- | --- | --- | --- |"
    for name, words, limits in CHARTS:
        mesh = meshes / name if (meshes / name).exists() else closed / name
        for limit in limits:
            runs = [flatten(program, mesh, folder, "hlle", "--maximum-stretch", str(limit)) for _ in range(repeat)]
            said = runs[0]
            yield (f"| {words} | {said['triangles']} | {limit} | {said['charts']} | {said['loops'] - said['charts']} | {said['method']} | "
                   f"{said['max_stretch']:.2f} | {min(run['processor_seconds'] for run in runs):.1f} |")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("--charts", type=pathlib.Path)
    parser.add_argument("--only")
    parser.add_argument("--write", type=pathlib.Path)
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        tables = [("accuracy", accuracy), ("methods", methods)]
        if arguments.charts:
            tables.append(("charts", lambda program, meshes, *rest: charts(program, meshes, arguments.charts, *rest)))
        for name, table in tables:
            if arguments.only not in (None, name):
                continue
            lines = list(table(arguments.program, arguments.meshes, folder, arguments.repeat))
            print("\n".join(lines), flush=True)
            if arguments.write:
                page_tables.write_table(arguments.write, f"flatten {name}", "\n".join(lines))


if __name__ == "__main__":
    sys.exit(main())
