# SPDX-License-Identifier: BSD-3-Clause
"""A cylinder on a cube, meshed as it is and imprinted: points of the cylinder's foot that the cube has too, and those that it has not.

usage: cad_imprint.py [--output DIR]
"""
import os
import subprocess

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkGlyph3D
from vtkmodules.vtkFiltersSources import vtkSphereSource

import _scene as scene
import cad_fit_examples as drawing
from cad_modification import PROGRAM, RED

PART = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Testing", "Data", "Parts", "cylinder_on_cube.step")
LIFTED = np.array((0.0, 0.0, 7.0))  # of the cylinder, to look between
TOP = 20.0                          # of the cube
GREEN = scene.COLOURS[2]


def quads_of(file):
    """Points, quadrilaterals of either solid."""
    made = knotwork.vtkCADQuads()
    made.SetFileName(file)
    made.SetEdgeLength(2.5)
    mesh = scene.updated(made).GetOutputDataObject(0)
    cells = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 4)
    solids = [vtk_to_numpy(mesh.GetCellData().GetArray(name)) for name in ("SolidId", "SecondSolidId")]
    return vtk_to_numpy(mesh.GetPoints().GetData()), [cells[(solids[0] == s) | (solids[1] == s)] for s in (0, 1)]


def surface(points, cells, colour):
    mesh = vtkPolyData()
    mesh.ShallowCopy(scene.triangle_mesh(points, cells[:, :3]))
    mesh.Allocate(len(cells))
    for cell in cells:
        mesh.InsertNextCell(9, 4, [int(i) for i in cell])
    shown = scene.actor(mesh, colour, lighting=True)
    shown.GetProperty().SetInterpolationToFlat()
    shown.GetProperty().EdgeVisibilityOn()
    shown.GetProperty().SetEdgeColor(*scene.INK)
    return shown


def balls(points, colour):
    sphere = vtkSphereSource()
    sphere.SetRadius(0.35)
    sphere.SetThetaResolution(16)
    sphere.SetPhiResolution(12)
    glyphs = vtkGlyph3D()
    glyphs.SetInputData(scene.triangle_mesh(points, np.empty((0, 3), int)))
    glyphs.SetSourceConnection(sphere.GetOutputPort())
    glyphs.ScalingOff()
    return scene.actor(scene.updated(glyphs).GetOutput(), colour, lighting=True)


def panel(k, file, title):
    points, (cube, cylinder) = quads_of(file)
    if points[np.unique(cube), 2].min() > points[np.unique(cylinder), 2].min():
        cube, cylinder = cylinder, cube
    foot = np.unique(cylinder)[np.abs(points[np.unique(cylinder), 2] - TOP) < 1e-9]
    common = np.isin(foot, cube)
    text = f"{title}: {common.sum()} of {len(foot)} points of the foot are the cube's"
    print(text)
    items = [surface(points, cube, scene.COLOURS[0]), surface(points + LIFTED, cylinder, scene.COLOURS[1])]
    for chosen, colour in ((common, GREEN), (~common, RED)):
        if chosen.any():
            places = points[foot[chosen]]
            rim = np.linalg.norm(places[:, :2] - 10.0, axis=1) > 6.0 - 1e-6
            items += [balls(places[rim], colour), balls(places[rim] + LIFTED, colour)]
    return drawing.seen(items, k, 2, text, (60, -60, 66), (10, 10, 16), 0.88)


def main():
    folder = scene.output_folder()
    shared = os.path.join(folder, "cad_imprint.brep")
    subprocess.run([PROGRAM, "cadmodify", PART, "--imprint", "--output", shared, "--force", "--quiet"], check=True)
    panels = [panel(0, PART, "as it is"), panel(1, shared, "imprinted and merged")]
    scene.save(panels, os.path.join(folder, "cad_imprint.png"), (1400, 720))


if __name__ == "__main__":
    main()
