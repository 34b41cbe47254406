# SPDX-License-Identifier: BSD-3-Clause
"""A plate with two holes, cut into eight patches that are parameterized together: first and optimized maps.

usage: layouts.py [--output DIR]
"""
import json
import math
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_QUAD, vtkUnstructuredGrid

import _scene as scene
from certified_maps import validated, wave

HOLES = ((-1.1, 0.08, 0.36), (1.0, -0.05, 0.44))  # x, y, radius
HEIGHTS = (0.3, 0.3, 0.2, 0.3, 0.3, 0.2)  # of the waves
RIM = [(-2, -1), (0, -1), (2, -1), (2, 1), (0, 1), (-2, 1)]


def arc(centre, radius, begin, end):
    """A circular arc of less than 180 degrees."""
    half, middle = (end - begin) / 2, (end + begin) / 2
    at = [(begin, 1), (middle, 1 / math.cos(half)), (end, 1)]
    points = [[centre[0] + radius * r * math.cos(a), centre[1] + radius * r * math.sin(a)] for a, r in at]
    return {"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "weights": [1, math.cos(half), 1], "control_points": points}


def plate():
    """Vertices, quadrilaterals and boundary curves."""
    vertices, quads = [list(p) for p in RIM], []
    curves = [wave(RIM[k], RIM[(k + 1) % 6], HEIGHTS[k], 1) for k in range(6)]
    for h, (x, y, radius) in enumerate(HOLES):
        corners = [0, 1, 4, 5] if h == 0 else [1, 2, 3, 4]
        first = len(vertices)
        angles = [math.radians(225 + 90 * k) for k in range(5)]
        vertices += [[x + radius * math.cos(a), y + radius * math.sin(a)] for a in angles[:4]]
        curves += [arc((x, y), radius, angles[k], angles[k + 1]) for k in range(4)]
        quads += [[corners[k], corners[(k + 1) % 4], first + (k + 1) % 4, first + k] for k in range(4)]
    return vertices, quads, curves


def mesh(vertices, quads):
    """The layout: one quadrilateral a patch."""
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.c_[np.array(vertices, float), np.zeros(len(vertices))], deep=1))
    grid = vtkUnstructuredGrid()
    grid.SetPoints(points)
    for quad in quads:
        grid.InsertNextCell(VTK_QUAD, 4, quad)
    return grid


def panel(grid, title, viewport):
    """A map's elements in the colours of their verdicts, the patches' edges thick."""
    actors, verdict, injective = validated(grid, 0.8)
    edges = scene.actor(scene.patch_edges(grid), scene.INK, 3)
    edges.SetPosition(0, 0, 0.0015)
    result = scene.renderer(actors + [edges], viewport, 1.5)
    result.GetActiveCamera().SetWindowCenter(0, -0.08)  # room for the text
    text = scene.label(f"{title}: {verdict}, {injective.replace('_', ' ')}", 0.5, 0.03, 18)
    text.GetTextProperty().SetJustificationToCentered()
    result.AddActor(text)
    return result


def main():
    folder = scene.output_folder()
    vertices, quads, curves = plate()
    file = os.path.join(folder, "plate.json")
    with open(file, "w") as stream:
        json.dump({"curves": curves}, stream)
    reader = knotwork.vtkDomainBoundaryReader()
    reader.SetFileName(file)
    domain = knotwork.vtkDomainParameterization()
    domain.SetInputConnection(reader.GetOutputPort())
    domain.SetInputDataObject(1, mesh(vertices, quads))
    scene.updated(domain)
    if domain.GetVerdict() != 1:
        raise RuntimeError("the map of the plate is not proved valid")
    scene.save([panel(domain.GetOutputDataObject(1), "first map", (0, 0, 0.5, 1)),
                panel(domain.GetOutputDataObject(0), "optimized", (0.5, 0, 1, 1))],
               os.path.join(folder, "layouts.png"), (1200, 400))


if __name__ == "__main__":
    main()
