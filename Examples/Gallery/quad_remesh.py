# SPDX-License-Identifier: BSD-3-Clause
"""A closed scan of Debian's libcgal-demo, the quadrilaterals that QuadriFlow makes on it, and the spline that is fitted to the scan on these. The
program blender must be installed.

usage: quad_remesh.py [--output DIR]
"""
import os
import shutil

import knotwork
import numpy as np

import _scene as scene

MESH, FACES = "bear", 2000
DIRECTION, UP, ZOOM = (0.3, 0.2, 1.0), (0, 1, 0), 1.3
GREY, WARM, BLUE = (0.8, 0.8, 0.78), (0.95, 0.85, 0.65), (0.55, 0.7, 0.9)


def edged(polydata, colour):
    item = scene.actor(polydata, colour, lighting=True)
    item.GetProperty().EdgeVisibilityOn()
    item.GetProperty().SetEdgeColor(0.25, 0.25, 0.3)
    return item


def main():
    folder = scene.output_folder()
    if shutil.which("blender") is None:
        scene.leave_out("the program blender is missing; install Debian's package blender")
    mesh = scene.triangle_mesh(*scene.read_off(MESH + ".off"))
    remesher = knotwork.vtkQuadRemesher()
    remesher.SetInputDataObject(mesh)
    remesher.SetFaces(FACES)
    quads = scene.updated(remesher).GetOutputDataObject(0)
    numbers = remesher.GetOutputDataObject(2)
    fit = knotwork.vtkCADFit()
    fit.SetInputDataObject(quads)
    fit.SetTargetData(mesh)
    fit.SetDegree(2)
    scene.updated(fit)
    found = fit.GetOutputDataObject(1)
    tessellate = knotwork.vtkSplineTessellate()
    tessellate.SetInputConnection(fit.GetOutputPort())
    smooth = scene.updated(tessellate).GetOutputDataObject(0)
    words = (f"{mesh.GetNumberOfCells()} triangles", f"{quads.GetNumberOfCells()} quadrilaterals, {numbers.GetValueByName(0, 'ExtraordinaryPoints').ToInt()} "
             "extraordinary points", f"{found.GetValueByName(0, 'Verdict').ToString()} spline, degree 2, {found.GetValueByName(0, 'Patches').ToInt()} patches")
    print(*words, sep="; ")
    views = []
    for k, item in enumerate((edged(mesh, GREY), edged(quads, WARM), scene.actor(smooth, BLUE, lighting=True))):
        view = scene.renderer([item], (k / 3, 0, (k + 1) / 3, 1), flat=False)
        camera = view.GetActiveCamera()
        camera.SetPosition(*(np.array(camera.GetFocalPoint()) + DIRECTION))
        camera.SetViewUp(*UP)
        view.ResetCamera()
        camera.Zoom(ZOOM)
        view.AddViewProp(scene.label(words[k], 0.05, 0.02, 18))
        views.append(view)
    scene.save(views, os.path.join(folder, "quad_remesh.png"), (1800, 700))


if __name__ == "__main__":
    main()
