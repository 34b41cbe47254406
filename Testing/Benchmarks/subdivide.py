#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A finer mesh of a scan: simplified by quadrics to a quarter of a quarter ... of what is wanted, then subdivided (Loop).

usage: subdivide.py MESH.(off|ply|stl|obj) TRIANGLES OUT.ply

What large scans cost in `knotwork trim`: subdivide.py elephant.off 1000000 large.ply; knotwork trim large.ply --output large.step --report large.json
"""
import sys

import knotwork as kw
from vtkmodules.vtkFiltersCore import vtkQuadricDecimation
from vtkmodules.vtkFiltersModeling import vtkLoopSubdivisionFilter
from vtkmodules.vtkIOPLY import vtkPLYWriter


def subdivided(mesh, triangles):
    """The mesh with about so many triangles."""
    times = 0
    while mesh.GetNumberOfCells() * 4 ** times < triangles:
        times += 1
    simplified = vtkQuadricDecimation()
    simplified.SetInputData(mesh)
    simplified.SetTargetReduction(1 - triangles / 4 ** times / mesh.GetNumberOfCells())
    smooth = vtkLoopSubdivisionFilter()
    smooth.SetInputConnection(simplified.GetOutputPort())
    smooth.SetNumberOfSubdivisions(times)
    smooth.Update()
    return smooth.GetOutput()


def main(file, triangles, out):
    writer = vtkPLYWriter()
    writer.SetInputData(subdivided(kw.read(file), int(float(triangles))))
    writer.SetFileName(out)
    writer.Write()
    print(f"{writer.GetInput().GetNumberOfCells()} triangles")


if __name__ == "__main__":
    main(*sys.argv[1:])
