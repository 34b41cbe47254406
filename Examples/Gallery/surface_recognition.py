# SPDX-License-Identifier: BSD-3-Clause
"""Triangle meshes of machined parts, in the colours of the surfaces that are found in them, with the edges between them.

A fan disk, a coupling and a joint of Debian's libcgal-demo.

usage: surface_recognition.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.vtkFiltersSources import vtkPlaneSource
from vtkmodules.vtkRenderingCore import vtkMapper

import _scene as scene

# a mesh, where it is looked at from, what is up, and how much it is enlarged
PARTS = (("fandisk", (1.0, -0.8, 0.7), (0, 0, 1), 1.15), ("couplingdown", (-1.0, -0.6, -1.2), (0, 0, -1), 1.25),
         ("joint", (1.0, -0.8, 0.7), (0, 0, 1), 1.05))
TYPES = (("plane", "Planes", (0.72, 0.83, 0.92)), ("cylinder", "Cylinders", (0.95, 0.73, 0.35)), ("sphere", "Spheres", (0.36, 0.70, 0.55)),
         ("cone", "Cones", (0.95, 0.90, 0.45)), ("torus", "Tori", (0.86, 0.45, 0.30)), ("free form", "FreeForms", (0.70, 0.70, 0.70)), ("extrusion", "Extrusions", (0.55, 0.75, 0.78)),
         ("revolution", "Revolutions", (0.85, 0.62, 0.70)))
LEGEND = 0.1  # share of the height


def counted(word, count):
    """One sphere, two spheres, tori."""
    return f"{count} {word if count == 1 else 'tori' if word == 'torus' else word + 's'}"


def panel(k, name, direction, up, zoom):
    recognition = knotwork.vtkSurfaceRecognition()
    recognition.SetInputDataObject(scene.triangle_mesh(*scene.read_off(name + ".off")))
    triangles = scene.updated(recognition).GetOutputDataObject(0)
    table = recognition.GetOutputDataObject(3)
    print(name, ", ".join(f"{table.GetColumnName(i)} {table.GetValue(0, i).ToString()}" for i in range(table.GetNumberOfColumns())))
    counts = [(word, table.GetValueByName(0, column).ToInt()) for word, column, _ in TYPES]
    edges = scene.actor(recognition.GetOutputDataObject(1), scene.INK, line_width=2.5)
    edges.GetMapper().SetRelativeCoincidentTopologyLineOffsetParameters(0, -8)
    view = scene.renderer([scene.coloured_cells(triangles, "SurfaceType", [colour for _, _, colour in TYPES]), edges], (k / len(PARTS), LEGEND, (k + 1) / len(PARTS), 1))
    camera = view.GetActiveCamera()
    camera.SetPosition(*(np.array(camera.GetFocalPoint()) + direction))
    camera.SetViewUp(*up)
    view.ResetCamera()
    camera.Zoom(zoom)
    view.AddViewProp(scene.label(", ".join(counted(word, count) for word, count in counts if count), 0.05, 0.02, 15))
    return view


def legend(types, width, height):
    """A square of every colour, and its word."""
    step = width / (len(types) + 0.5)
    squares = []
    for k, (_, _, colour) in enumerate(types):
        square = vtkPlaneSource()
        square.SetOrigin((k + 0.4) * step, 0.3 * height, 0)
        square.SetPoint1((k + 0.4) * step + 0.4 * height, 0.3 * height, 0)
        square.SetPoint2((k + 0.4) * step, 0.7 * height, 0)
        squares.append(scene.actor(scene.updated(square).GetOutput(), colour))
    view = scene.renderer(squares, (0, 0, 1, LEGEND))
    camera = view.GetActiveCamera()
    camera.SetFocalPoint(width / 2, height / 2, 0)
    camera.SetPosition(width / 2, height / 2, width)
    camera.SetParallelScale(height / 2)
    view.ResetCameraClippingRange()
    for k, (word, _, _) in enumerate(types):
        view.AddViewProp(scene.label(word, ((k + 0.4) * step + 0.55 * height) / width, 0.3))
    return view


def main():
    vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
    size = (1200, 480)
    panels = [panel(k, *part) for k, part in enumerate(PARTS)]
    scene.save([*panels, legend(TYPES[:-1], size[0], LEGEND * size[1])], os.path.join(scene.output_folder(), "surface_recognition.png"), size)


if __name__ == "__main__":
    main()
