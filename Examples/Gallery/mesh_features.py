# SPDX-License-Identifier: BSD-3-Clause
"""Noisy triangle meshes of machined parts in the colours of their regions, with their sharp edges: by the normals of the triangles, and by normals
that are fitted to patches as large as the noise asks for.

A fan disk, and a joint whose triangles are divided, of Debian's libcgal-demo, with noise of a thousandth of the diagonal.

usage: mesh_features.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.vtkFiltersModeling import vtkLinearSubdivisionFilter
from vtkmodules.vtkRenderingCore import vtkMapper
from vtkmodules.util.numpy_support import vtk_to_numpy

import _scene as scene

# a mesh, times it is divided, where it is looked at from, what is up; standard deviation of the noise, share of the diagonal
PARTS = (("fandisk", 0, (1.0, -0.8, 0.7), (0, 0, 1)), ("joint", 2, (1.0, -0.8, 0.7), (0, 0, 1)))
NOISE = 1e-3
PALE = [tuple(0.45 + 0.55 * channel for channel in colour) for colour in scene.COLOURS]


def noisy(name, divisions):
    mesh = scene.triangle_mesh(*scene.read_off(name + ".off"))
    if divisions:
        divide = vtkLinearSubdivisionFilter()
        divide.SetInputData(mesh)
        divide.SetNumberOfSubdivisions(divisions)
        mesh = scene.updated(divide).GetOutput()
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    points += np.random.default_rng(1).normal(0, NOISE * np.linalg.norm(np.ptp(points, axis=0)), points.shape)
    return mesh


def panel(mesh, noise, direction, up, viewport, text, zoom):
    features = knotwork.vtkMeshFeatures()
    features.SetInputDataObject(mesh)
    features.SetNoiseLevel(noise)
    regions = scene.updated(features).GetOutputDataObject(0)
    table = features.GetOutputDataObject(3)
    print(text, ", ".join(f"{table.GetColumnName(i)} {table.GetValue(0, i).ToString()}" for i in range(table.GetNumberOfColumns())))
    ids = regions.GetCellData().GetArray("RegionId")
    for cell in range(ids.GetNumberOfTuples()):
        ids.SetValue(cell, ids.GetValue(cell) % len(PALE))
    lines = scene.actor(features.GetOutputDataObject(1), scene.INK, line_width=2.5)
    lines.GetMapper().SetRelativeCoincidentTopologyLineOffsetParameters(0, -8)
    view = scene.renderer([scene.coloured_cells(regions, "RegionId", PALE), lines], viewport)
    camera = view.GetActiveCamera()
    camera.SetPosition(*(np.array(camera.GetFocalPoint()) + direction))
    camera.SetViewUp(*up)
    view.ResetCamera()
    camera.Zoom(zoom)
    count = table.GetValueByName(0, "Regions").ToInt()
    view.AddViewProp(scene.label(f"{text}: {count} {'region' if count == 1 else 'regions'}", 0.04, 0.02, 17))
    return view


def main():
    vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
    panels = []
    for row, (name, divisions, direction, up) in enumerate(PARTS):
        mesh = noisy(name, divisions)
        for column, (level, text) in enumerate(((0.0, "normals of triangles"), (-1.0, "fitted normals"))):
            viewport = (column / 2, (1 - row) / 2, (column + 1) / 2, (2 - row) / 2)
            panels.append(panel(mesh, level, direction, up, viewport, text, 1.15 if row == 0 else 1.0))
    scene.save(panels, os.path.join(scene.output_folder(), "mesh_features.png"), (1000, 860))


if __name__ == "__main__":
    main()
