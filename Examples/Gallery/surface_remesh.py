# SPDX-License-Identifier: BSD-3-Clause
"""A part of Debian's libcgal-demo: its triangles as they are given, with edges of one length, and of lengths by curvature; sharp edges red.

usage: surface_remesh.py [--output DIR]
"""
import os

import knotwork
import numpy as np

import _scene as scene

MESH = "fandisk"
DIRECTION, UP, ZOOM = (1.0, 0.5, 0.8), (0, 1, 0), 0.72
GREY, WARM, BLUE, RED = (0.8, 0.8, 0.78), (0.95, 0.85, 0.65), (0.55, 0.7, 0.9), (0.85, 0.15, 0.1)


def edged(polydata, colour):
    item = scene.actor(polydata, colour, lighting=True)
    item.GetProperty().EdgeVisibilityOn()
    item.GetProperty().SetEdgeColor(0.25, 0.25, 0.3)
    return item


def remeshed(mesh, sizing, size, colour):
    """What is drawn, and words about it."""
    remesh = knotwork.vtkSurfaceRemesh()
    remesh.SetInputDataObject(mesh)
    remesh.SetSizing(sizing)
    remesh.SetSize(size)
    scene.updated(remesh)
    numbers = remesh.GetOutputDataObject(2)
    number = lambda name: numbers.GetValueByName(0, name).ToDouble()  # noqa: E731
    print(", ".join(f"{numbers.GetColumnName(i)} {numbers.GetValue(0, i).ToString()}" for i in range(numbers.GetNumberOfColumns())))
    lines = scene.actor(remesh.GetOutputDataObject(1), RED)
    lines.GetProperty().SetLineWidth(3)
    largest = max(number("DistanceFromInput"), number("DistanceToInput")) / number("Diagonal")
    return ([edged(remesh.GetOutputDataObject(0), colour), lines],
            f"{int(number('TrianglesAfter'))} triangles; at most {largest:.1e} of the diagonal off")


def main():
    points, triangles = scene.read_off(MESH + ".off")
    mesh = scene.triangle_mesh(points, triangles)
    size = 0.025 * np.linalg.norm(np.ptp(points, axis=0))
    parts = [([edged(mesh, GREY)], f"{mesh.GetNumberOfCells()} triangles"),
             remeshed(mesh, knotwork.vtkSurfaceRemesh.CONSTANT, size, WARM),
             remeshed(mesh, knotwork.vtkSurfaceRemesh.CURVATURE, 0, BLUE)]
    views = []
    for k, (items, words) in enumerate(parts):
        view = scene.renderer(items, (k / 3, 0, (k + 1) / 3, 1), flat=False)
        camera = view.GetActiveCamera()
        camera.SetPosition(*(np.array(camera.GetFocalPoint()) + DIRECTION))
        camera.SetViewUp(*UP)
        view.ResetCamera()
        camera.Zoom(ZOOM)
        view.AddViewProp(scene.label(words, 0.05, 0.02, 18))
        views.append(view)
    scene.save(views, os.path.join(scene.output_folder(), "surface_remesh.png"), (1800, 700))


if __name__ == "__main__":
    main()
