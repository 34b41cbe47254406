# SPDX-License-Identifier: BSD-3-Clause
"""A piston, a tee and a cover, each from its STEP file: the hexahedra of the solids that it is cut into, moved apart, and the spline volume that is
fitted to the part.

usage: cad_hexahedra.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

import _scene as scene
import cad_fit
import cad_fit_examples as drawing

PARTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Testing", "Data", "Parts")
PART = os.path.join(PARTS, "piston.step")
CUTS = ("--cut-plane", "0", "0", "46", "0", "0", "1", "--cut-plane", "0", "0", "0", "1", "0", "0")
APART = 0.25  # of the way of a solid's centre from that of the part
SEEN_FROM = (260, -330, -250)
# part, length of the hexahedra's sides, seen from, towards
SHOWN = (("piston", 6, SEEN_FROM, (0, 0, 30)), ("tee", 3, (90, -140, 90), (0, 0, 8)), ("cover", 3.5, (90, -110, 100), (30, 20, 6)))


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


def panels_of(part, length, seen_from, middle, column):
    hexes = knotwork.vtkCADHexahedra()
    hexes.SetFileName(os.path.join(PARTS, part + ".step"))
    hexes.SetEdgeLength(length)
    scene.updated(hexes)
    mesh, numbers, solids = (hexes.GetOutputDataObject(port) for port in range(3))
    number = {name: numbers.GetValueByName(0, name).ToDouble() for name in ("Hexahedra", "ValidCells", "LeastScaledJacobian")}
    cuts = len(numbers.GetValueByName(0, "Cuts").ToString().splitlines())
    target = knotwork.vtkCADReader()
    target.SetFileName(hexes.GetFileName())
    target.SetChordalTolerance(1e-5)
    faces = scene.updated(target).GetOutputDataObject(2)
    made = cad_fit.fit(mesh, faces, Degree=2, BoundedElements=0)
    text = {name: drawing.text_of(made, name) for name in ("Verdict", "Functions", "MaxDistance")}
    spline = cad_fit.boundary(made.GetOutputDataObject(0))
    count = solids.GetNumberOfRows()
    title = f"{number['Hexahedra']:.0f} hexahedra, {number['ValidCells']:.0f} valid, in {count} solid{'s'[:count > 1]} after {cuts} cut{'s'[:cuts != 1]}"
    shown = []
    for row, (items, said) in enumerate((
            ([cad_fit.edged(piece, colour) for piece, colour in apart(mesh)], title),
            ([scene.actor(cad_fit.drawn(spline), scene.COLOURS[0], lighting=True), drawing.lines_of(drawing.element_lines(spline), 1)],
             f"one spline, {text['Verdict']}: {text['Functions']} functions, {float(text['MaxDistance']):.2f} mm off at most"))):
        print(part, said)
        view = drawing.seen(items, column, len(SHOWN), said, seen_from, middle, 0.95)
        left, _, right, _ = view.GetViewport()
        view.SetViewport(left, 0.5 * (1 - row), right, 0.5 * (2 - row))
        shown.append(view)
    return shown


def main():
    folder = scene.output_folder()
    panels = [view for column, shown in enumerate(SHOWN) for view in panels_of(*shown, column)]
    scene.save(panels, os.path.join(folder, "cad_hexahedra.png"), (1500, 1100))


if __name__ == "__main__":
    main()
