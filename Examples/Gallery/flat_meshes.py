# SPDX-License-Identifier: BSD-3-Clause
"""Meshes with a boundary and their images in the plane (flat_meshes.png).

A patch of a CAD model and a bust of Debian's libcgal-demo, an S on a cone that is made here. Above the mesh, below the plane; colours
say how far a triangle is stretched or shrunk: white not at all, dark by half or more.
"""
import math
import os

import _scene as scene
import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper


def s_on_cone(edge=0.1):
    """A stroke in the shape of an S, drawn on a cone without distortion."""
    nx, ny = round(3 / edge), round(5 / edge)
    x, y = np.meshgrid(np.linspace(1.5, 4.5, nx + 1), np.linspace(-2.5, 2.5, ny + 1))
    flat = np.c_[x.ravel(), y.ravel()]
    first = (np.arange(ny)[:, None] * (nx + 1) + np.arange(nx)).ravel()
    triangles = np.vstack([np.c_[first, first + 1, first + nx + 2], np.c_[first, first + nx + 2, first + nx + 1]])
    centres = flat[triangles].mean(1)

    def arc(centre, start):
        to = centres - centre
        angle = (np.arctan2(to[:, 1], to[:, 0]) - start) % (2 * math.pi)
        return (angle < 1.5 * math.pi) & (abs(np.hypot(*to.T) - 1) < 0.3)

    triangles = triangles[arc((3, 1), 0) | arc((3, -1), math.pi)]
    used, cells = np.unique(triangles, return_inverse=True)
    radius, turn = np.hypot(*flat[used].T), 2 * np.arctan2(flat[used, 1], flat[used, 0])
    points = np.c_[0.5 * radius * np.cos(turn), 0.5 * radius * np.sin(turn), -math.sqrt(0.75) * radius]
    return scene.triangle_mesh(points, cells.reshape(-1, 3))


def flattened(mesh, method="HLLE", flat=True):
    parameterization = knotwork.vtkMeshParameterization()
    parameterization.SetInputDataObject(mesh)
    parameterization.SetMethod(getattr(parameterization, method))
    parameterization.SetFlatOutput(flat)
    return scene.updated(parameterization)


def stretched(mesh):
    """Triangles: orange stretched, blue shrunk, red flipped."""
    values = vtk_to_numpy(mesh.GetCellData().GetArray("SingularValues"))
    change = np.log2(np.sqrt(np.maximum(abs(values[:, 0] * values[:, 1]), 1e-12))).clip(-1, 1)[:, None]
    white, orange, blue = np.array([1.0, 0.98, 0.94]), np.array([0.93, 0.45, 0.1]), np.array([0.1, 0.4, 0.8])
    colours = white + abs(change) * (np.where(change > 0, orange, blue) - white)
    colours[values[:, 1] <= 0] = (0.8, 0.05, 0.15)
    coloured = vtkPolyData()
    coloured.ShallowCopy(mesh)
    coloured.GetCellData().SetScalars(numpy_to_vtk((255 * colours).round().astype(np.uint8), deep=1))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(coloured)
    mapper.SetScalarModeToUseCellData()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.55, 0.55, 0.55)
    actor.GetProperty().SetLighting(False)
    return actor


def panel(mesh, viewport, text, method="HLLE", flat=True):
    result = flattened(mesh, method, flat)
    table = result.GetOutputDataObject(2)
    loops = scene.actor(result.GetOutputDataObject(1), scene.INK, 2)
    shown = scene.renderer([stretched(result.GetOutputDataObject(0)), loops], viewport, 0.92, flat)
    if text:
        used = table.GetValueByName(0, "Method").ToString()
        flips = table.GetValueByName(0, "FlippedTriangles").ToInt()
        stretch = table.GetValueByName(0, "MeanStretch").ToDouble()
        shown.AddActor(scene.label(f"{used}: {flips} of {result.GetOutputDataObject(0).GetNumberOfCells()} flipped, stretch {stretch:.3f}",
                                   0.04, 0.03, 14))
    return shown


def main():
    folder = scene.output_folder()
    letter = s_on_cone()
    patch = scene.triangle_mesh(*scene.read_off("patch-20.off"))
    bust = scene.triangle_mesh(*scene.read_off("nefertiti.off"))
    columns = [(letter, "HLLE"), (letter, "ISOMAP"), (patch, "HLLE"), (bust, "HLLE")]
    panels = []
    for k, (mesh, method) in enumerate(columns):
        left, right = k / len(columns), (k + 1) / len(columns)
        panels.append(panel(mesh, (left, 0.5, right, 1), False, method, False))
        panels.append(panel(mesh, (left, 0, right, 0.5), True, method))
    scene.save(panels, os.path.join(folder, "flat_meshes.png"), (1200, 640))


if __name__ == "__main__":
    main()
