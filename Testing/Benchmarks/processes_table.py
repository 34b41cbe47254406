#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Scaling of jobs over processes and over threads: one and two of each, on work of about ten seconds.

usage: processes_table.py PROGRAM [--seconds S] [--folder FOLDER] [--write PAGE]

--seconds: of one thread that the work is made for (10). --write puts the tables between the comments `the table of processes: begin` and `end` of a page.
Every run is one thread a process, or two threads of one process; the fastest of three. Processes that wait for others use the processor, too. "seconds" are those of the job's work (`seconds` of the report, the
largest of the processes), without start and files; memory is the largest resident set of a process, "own" without pages of files (libraries), which processes of one machine have in
common; the share of the work is that of the processor time.
Weak scaling doubles the cells or points with the processes. processes_model.py is a model of them.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import page_tables

MPIRUN = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "core", "--quiet", "-np"]
CELLS_OF_AN_ELEMENT = 128  # of a solid tube halved three times where it is curved
HEAD = ["job", "work", "1 thread, s", "2 threads, s", "2 processes, s", "gain of threads", "of processes", "processes / threads", "least and largest share of the work",
        "MB, one process", "MB, each of two", "own MB, one process", "own MB, each of two", "share", "twice the work by two, s"]


def run(program, folder, processes, threads, words):
    """The best of three reports of a job."""
    best = None
    for _ in range(3):
        command = [program, *map(str, words), "--threads", str(threads), "--report", "report.json", "--force", "--quiet"]
        subprocess.run((MPIRUN + [str(processes)] if processes > 1 else []) + command, cwd=folder, check=False, stdout=subprocess.DEVNULL)
        with open(os.path.join(folder, "report.json"), encoding="utf-8") as stream:
            report = json.load(stream)
        report["seconds"] = max(report.get("rank_seconds", [report["seconds"]]))
        best = report if best is None or report["seconds"] < best["seconds"] else best
    return best


def make_grid(program, folder, name, elements):
    """A curved solid of so many Bezier elements in a direction, in two pieces too. Without the spline's definition: patches would stay whole."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter
    job = [program, "source", "--shape", "solid-tube", "--elements", *map(str, elements), "--output", "spline.vtu", "--force", "--quiet"]
    subprocess.run(job, cwd=folder, check=True)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(os.path.join(folder, "spline.vtu"))
    reader.Update()
    grid = reader.GetOutput()
    grid.GetFieldData().Initialize()
    for array in ("PatchBasis", "ElementId"):
        grid.GetCellData().RemoveArray(array)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    writer.SetFileName(os.path.join(folder, name + ".vtu"))
    writer.Write()
    words = [program, "convert", name + ".vtu", "--output", name + ".pvtu", "--force", "--quiet", "--pieces", "2"]
    subprocess.run(words, cwd=folder, check=True)


def make_points(folder, name, n, heights=None):
    """Points beside the unit square, or with heights of x and y, as polydata in two pieces."""
    import numpy as np
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
    rows = np.random.default_rng(1).uniform(0.02, 0.98, (n, 3))
    rows[:, 2] = rows[:, 2] - 0.5 if heights is None else heights(rows[:, 0], rows[:, 1]) + 0.01 * (rows[:, 2] - 0.5)
    parts = {name + ".vtp": rows, os.path.join(name, name + "_0.vtp"): rows[:n // 2], os.path.join(name, name + "_1.vtp"): rows[n // 2:]}
    os.makedirs(os.path.join(folder, name), exist_ok=True)
    for file, part in parts.items():
        points = vtkPoints()
        points.SetDataTypeToDouble()
        points.SetData(numpy_to_vtk(part, deep=True))
        data = vtkPolyData()
        data.SetPoints(points)
        writer = vtkXMLPolyDataWriter()
        writer.SetInputData(data)
        writer.SetFileName(os.path.join(folder, file))
        writer.SetDataModeToBinary()
        writer.Write()
    index = "".join(f'<Piece Source="{name}/{name}_{i}.vtp"/>' for i in range(2))
    with open(os.path.join(folder, name + ".pvtp"), "w", encoding="utf-8") as stream:
        stream.write('<?xml version="1.0"?><VTKFile type="PPolyData" version="1.0"><PPolyData GhostLevel="0"><PPointData/><PCellData/><PPoints>'
                     f'<PDataArray type="Float64" Name="Points" NumberOfComponents="3"/></PPoints>{index}</PPolyData></VTKFile>\n')


def hills(x, y):
    """Six octaves."""
    import numpy as np
    return sum(0.15 / 2 ** k * np.sin(2 ** k * 6.3 * (x * np.cos(k) + y * np.sin(k)) + k) * np.cos(2 ** k * 6.3 * (y * np.cos(k) - x * np.sin(k))) for k in range(6))


def surface(program, folder):
    """A bicubic surface of some thousand elements over the unit square."""
    import numpy as np
    x, y = np.meshgrid(np.linspace(0, 1, 120), np.linspace(0, 1, 120))
    rows = np.column_stack([x.ravel(), y.ravel(), (0.2 * np.sin(17 * x) * np.cos(13 * y)).ravel()])
    np.savetxt(os.path.join(folder, "rows.xyz"), rows)
    subprocess.run([program, "fit", "rows.xyz", "--tolerance", "1e-3", "--degree", "3", "--output", "surface.vtu", "--force", "--quiet"], cwd=folder, check=True)


def jobs(program, folder):
    """Jobs, what makes their work of about a size in the folder and tells its size, and their words."""
    def grid(cells):
        n = max(2, round((cells / 4) ** (1 / 3)))
        make_grid(program, folder, "work", (n, n, n))
        return 4 * n ** 3

    def points(n):
        make_points(folder, "work", n)
        return n

    def terrain(n):
        make_points(folder, "work", n, hills)
        return n

    def cells(n):
        return CELLS_OF_AN_ELEMENT * grid(n / CELLS_OF_AN_ELEMENT)

    return (("`validate --injectivity off`", grid, lambda name, pieces: ["validate", name + (".pvtu" if pieces else ".vtu"), "--injectivity", "off", "--relative-gap",
                                                                          "0.01", "--bound-maximum"]),
            ("`tessellate --cells volume`", cells, lambda name, pieces: ["tessellate", name + ".vtu", "--cells", "volume", "--chordal-tolerance", "1e-12",
                                                                         "--maximum-subdivision", "3", "--maximum-cells", "2000000000", "--output", "cells.pvtu"]),
            ("`evaluate --mode probe`", points, lambda name, pieces: ["evaluate", "surface.vtu", name + (".pvtp" if pieces else ".vtp"), "--mode", "probe",
                                                                      "--output", "out.pvtp"]),
            ("`distance --kind closest`", points, lambda name, pieces: ["distance", name + (".pvtp" if pieces else ".vtp"), "surface.vtu", "--kind", "closest",
                                                                        "--output", "out.pvtp"]),
            ("`fit`", terrain, lambda name, pieces: ["fit", name + (".pvtp" if pieces else ".vtp"), "--tolerance", "0.015", "--output", "out.vtu"]))


def row(program, folder, job, seconds, make, words_of):
    """A row of the table: the size is found by a small run, and by one of about a quarter, in which what does not grow with it counts less."""
    size = 20000
    for share in (0.25, 1.0):
        size = make(size)
        size = int(size * share * seconds / max(run(program, folder, 1, 1, words_of("work", False))["seconds"], 1e-3))
    size = make(size)
    alone = run(program, folder, 1, 1, words_of("work", False))
    threads = run(program, folder, 1, 2, words_of("work", False))
    both = run(program, folder, 2, 1, words_of("work", True))
    make(2 * size)
    twice = run(program, folder, 2, 1, words_of("work", True))
    shares = [value / sum(both["rank_cpu_seconds"]) for value in both["rank_cpu_seconds"]]
    held = [value for key in ("peak_bytes", "peak_own_bytes") for value in (alone[key], max(both["rank_" + key]))]
    gains = alone["seconds"] / threads["seconds"], alone["seconds"] / both["seconds"]
    return [job, f"{size:.2g}".replace("e+0", "e"), *(f"{one['seconds']:.2f}" for one in (alone, threads, both)), *(f"{gain:.2f}" for gain in gains),
            f"{gains[1] / gains[0]:.2f}", f"{min(shares):.2f}, {max(shares):.2f}", *(f"{one / 1e6:.0f}" for one in held),
            f"{held[3] / held[2]:.2f}", f"{twice['seconds']:.2f}"]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--folder")
    parser.add_argument("--write")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    rows = []
    with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
        surface(program, folder)
        for job, make, words_of in jobs(program, folder):
            rows.append(row(program, folder, job, arguments.seconds, make, words_of))
            print(" | ".join(rows[-1]), file=sys.stderr, flush=True)
    table = page_tables.table_text(HEAD, rows)
    print(table, end="")
    if arguments.write:
        page_tables.write_table(arguments.write, "the table of processes", table)


if __name__ == "__main__":
    main()
