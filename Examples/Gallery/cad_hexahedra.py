# SPDX-License-Identifier: BSD-3-Clause
"""A piston cut into four solids, the hexahedra that are swept in them, and the spline volume that is fitted to the part.

usage: cad_hexahedra.py [--output DIR]
"""
import os
import subprocess

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

import _scene as scene
import cad_fit
import cad_fit_examples as drawing
from cad_modification import PROGRAM

PART = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Testing", "Data", "Parts", "piston.step")
CUTS = ("--cut-plane", "0", "0", "46", "0", "0", "1", "--cut-plane", "0", "0", "0", "1", "0", "0")
APART = 0.25  # of the way of a solid's centre from that of the part
SEEN_FROM = (260, -330, -250)


def apart(mesh):
    """Solids moved away from each other: points that they share are there for each of them."""
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 8)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    solids = vtk_to_numpy(mesh.GetCellData().GetArray("SolidId"))
    pieces = []
    for solid in np.unique(solids):
        used, ids = np.unique(cells[solids == solid], return_inverse=True)
        own = points[used]
        piece = vtkUnstructuredGrid()
        places = mesh.GetPoints().NewInstance()
        places.SetData(numpy_to_vtk(own + APART * (own.mean(0) - points.mean(0)), deep=1))
        piece.SetPoints(places)
        for corners in ids.reshape(-1, 8):
            piece.InsertNextCell(mesh.GetCellType(0), 8, [int(i) for i in corners])
        pieces.append((piece, scene.COLOURS[int(solid) % len(scene.COLOURS)]))
    return pieces


def main():
    folder = scene.output_folder()
    cut = os.path.join(folder, "piston.brep")
    subprocess.run([PROGRAM, "cadmodify", PART, *CUTS, "--output", cut, "--force", "--quiet"], check=True)
    hexes = knotwork.vtkCADHexahedra()
    hexes.SetFileName(cut)
    hexes.SetEdgeLength(6)
    scene.updated(hexes)
    mesh, numbers = hexes.GetOutputDataObject(0), hexes.GetOutputDataObject(1)
    number = {name: numbers.GetValueByName(0, name).ToDouble() for name in ("Hexahedra", "ValidCells", "LeastScaledJacobian")}
    target = knotwork.vtkCADReader()
    target.SetFileName(PART)
    target.SetChordalTolerance(1e-5)
    faces = scene.updated(target).GetOutputDataObject(2)
    made = cad_fit.fit(mesh, faces, Degree=2)
    text = {name: drawing.text_of(made, name) for name in ("Verdict", "Functions", "MaxDistance")}
    spline = cad_fit.boundary(made.GetOutputDataObject(0))
    panels = []
    for k, (items, title) in enumerate((
            ([cad_fit.edged(piece, colour) for piece, colour in apart(mesh)],
             f"{number['Hexahedra']:.0f} hexahedra in 4 solids, {number['ValidCells']:.0f} valid, least scaled Jacobian {number['LeastScaledJacobian']:.2f}"),
            ([scene.actor(cad_fit.drawn(spline), scene.COLOURS[0], lighting=True), drawing.lines_of(drawing.element_lines(spline), 1)],
             f"one spline, {text['Verdict']}: {text['Functions']} functions, {float(text['MaxDistance']):.2f} mm off at most"))):
        print(title)
        panels.append(drawing.seen(items, k, 2, title, SEEN_FROM, (0, 0, 30), 0.95))
    scene.save(panels, os.path.join(folder, "cad_hexahedra.png"), (1500, 700))


if __name__ == "__main__":
    main()
