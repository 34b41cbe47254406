# SPDX-License-Identifier: BSD-3-Clause
"""A bracket of bent sheet on its way to a spline solid: faces split and made composites, quadrilaterals over each composite as one face, the fit.

usage: cad_composites.py [--output DIR]
"""
import os
import subprocess

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

import _scene as scene
import cad_fit
import cad_fit_examples as drawing
from cad_modification import PROGRAM, tagged, triangles

PART = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Testing", "Data", "Parts", "bracket.step")
# both sides of the sheet as one face each; two of the rims are split where the bend begins
OPERATIONS = ("--composite", "1,5,7,15,16", "--composite", "3,12,13,18,19", "--split-plane", "6,8", "60", "0", "0", "1", "0", "0")
SEEN_FROM, FOCUS = (-90, -170, 190), (33, 22, 12)
PALE = (0.80, 0.84, 0.88)


def edged(mesh, array, colours):
    shown = scene.coloured_cells(mesh, array, colours)
    shown.GetProperty().EdgeVisibilityOn()
    shown.GetProperty().SetEdgeColor(*scene.INK)
    return shown


def groups(mesh):
    """Composites in colours of their own, other faces pale."""
    ids = vtk_to_numpy(mesh.GetCellData().GetArray("CompositeId")).astype(int)
    return tagged(mesh, "Group", ids + 1)


def main():
    folder = scene.output_folder()
    modified = os.path.join(folder, "cad_composites.step")
    subprocess.run([PROGRAM, "cadmodify", PART, *OPERATIONS, "--output", modified, "--force", "--quiet"], check=True)
    before, after = triangles(PART), triangles(modified)
    counts = [len(np.unique(vtk_to_numpy(mesh.GetCellData().GetArray("FaceId")))) for mesh in (before, after)]
    quads = knotwork.vtkCADQuads()
    quads.SetFileName(modified)
    quads.SetEdgeLength(4)
    scene.updated(quads)
    mesh, numbers = quads.GetOutputDataObject(0), quads.GetOutputDataObject(1)
    number = {name: numbers.GetValueByName(0, name).ToDouble() for name in ("Quads", "Faces", "LeastScaledJacobian")}
    target = knotwork.vtkCADReader()
    target.SetFileName(PART)
    target.SetChordalTolerance(1e-5)
    made = cad_fit.fit(mesh, scene.updated(target).GetOutputDataObject(2), Degree=2)
    text = {name: drawing.text_of(made, name) for name in ("Verdict", "Functions", "MaxDistance", "Volume")}
    spline = made.GetOutputDataObject(0)
    colours = (PALE, scene.COLOURS[0], scene.COLOURS[1])
    panels = []
    for k, (items, title) in enumerate((
            ([scene.coloured_cells(before, "FaceId", scene.COLOURS)], f"part: {counts[0]} faces"),
            ([scene.coloured_cells(groups(after), "Group", colours)], f"split: {counts[1]} faces; composites: {number['Faces']:.0f}"),
            ([edged(groups(mesh), "Group", colours)], f"{number['Quads']:.0f} quadrilaterals, least scaled Jacobian {number['LeastScaledJacobian']:.2f}"),
            ([scene.actor(cad_fit.drawn(spline), scene.COLOURS[0], lighting=True), drawing.lines_of(drawing.element_lines(spline), 1)],
             f"{text['Verdict']} spline, {text['Functions']} functions, {float(text['MaxDistance']):.3f} mm off"))):
        print(title)
        panels.append(drawing.seen(items, k, 4, title, SEEN_FROM, FOCUS, 0.9))
    print("volume", text["Volume"])
    scene.save(panels, os.path.join(folder, "cad_composites.png"), (2000, 560))


if __name__ == "__main__":
    main()
