# SPDX-License-Identifier: BSD-3-Clause
"""Triangle meshes of machined parts above, below the CAD models that are made of them: a colour a face, dark lines where faces meet.

A spool, a coupling, a joint and a part with faces of free form of Debian's libcgal-demo.

usage: analytic_models.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.vtkRenderingCore import vtkMapper

import _scene as scene

# a mesh, where it is looked at from, what is up, and how much it is enlarged
PARTS = (("spool", (1.0, -0.8, 0.6), (0, 0, 1), 1.2), ("couplingdown", (-1.0, -0.6, -1.2), (0, 0, -1), 1.25),
         ("joint", (1.0, -0.8, 0.7), (0, 0, 1), 1.05), ("part", (1.0, -0.9, 0.8), (0, 0, 1), 1.1))
COLOURS = ((0.72, 0.83, 0.92), (0.95, 0.73, 0.35), (0.36, 0.70, 0.55), (0.95, 0.90, 0.45), (0.86, 0.45, 0.30),
           (0.62, 0.60, 0.80), (0.80, 0.80, 0.78))


def view_of(actors, viewport, text, direction, up, zoom):
    view = scene.renderer(actors, viewport, flat=False)
    camera = view.GetActiveCamera()
    camera.SetPosition(*(np.array(camera.GetFocalPoint()) + direction))
    camera.SetViewUp(*up)
    view.ResetCamera()
    camera.Zoom(zoom)
    view.AddViewProp(scene.label(text, 0.05, 0.03, 15))
    return view


def panels(k, name, *camera):
    mesh = scene.triangle_mesh(*scene.read_off(name + ".off"))
    model = knotwork.vtkAnalyticModel()
    model.SetInputDataObject(mesh)
    triangles = scene.updated(model).GetOutputDataObject(0)
    curves = knotwork.vtkSplineTessellate()
    curves.SetInputDataObject(model.GetOutputDataObject(2))
    curves.SetChordalTolerance(1e-3)
    table = model.GetOutputDataObject(3)
    print(name, ", ".join(f"{table.GetColumnName(i)} {table.GetValue(0, i).ToString()}" for i in range(table.GetNumberOfColumns())))
    number = {column: table.GetValueByName(0, column).ToInt() for column in ("Faces", "FreeFaces", "Edges", "Lines", "Circles")}
    edges = scene.actor(scene.updated(curves).GetOutputDataObject(0), scene.INK, line_width=2.5)
    edges.GetMapper().SetRelativeCoincidentTopologyLineOffsetParameters(0, -8)
    given = scene.actor(mesh, (0.80, 0.82, 0.84), lighting=True)
    given.GetProperty().EdgeVisibilityOn()
    given.GetProperty().SetEdgeColor(0.25, 0.28, 0.32)
    given.GetProperty().SetInterpolationToFlat()
    left, right = k / len(PARTS), (k + 1) / len(PARTS)
    return [view_of([given], (left, 0.5, right, 1), f"{mesh.GetNumberOfCells()} triangles", *camera),
            view_of([scene.coloured_cells(triangles, "FaceId", COLOURS), edges], (left, 0, right, 0.5),
                    f"{number['Faces']} faces, {number['FreeFaces']} of splines, {number['Edges']} edges", *camera)]


def main():
    vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
    scene.save([view for k, part in enumerate(PARTS) for view in panels(k, *part)],
               os.path.join(scene.output_folder(), "analytic_models.png"), (1500, 760))


if __name__ == "__main__":
    main()
