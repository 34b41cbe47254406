# SPDX-License-Identifier: BSD-3-Clause
"""Trimmed faces from the charts of three methods (chart_faces.png): a bust of Debian's libcgal-demo by
Isomap, Laplacian eigenmaps and Hessian eigenmaps, without a fallback; the charts above (orange stretched, blue shrunk), below the
surfaces over their rectangles with the trimmed parts in orange.

usage: chart_faces.py [--output DIR]
"""
import os

import _scene as scene
import knotwork
from flat_meshes import stretched
from trimmed_faces import ORANGE, curves, number, surface_actor

CHARTS = (("ISOMAP", "Isomap"), ("LAPLACIAN", "Laplacian eigenmaps"), ("HLLE", "Hessian eigenmaps"))


def laid_out(mesh, method, flat):
    made = knotwork.vtkMeshParameterization()
    made.SetInputDataObject(mesh)
    made.SetMethod(getattr(made, method))
    made.FallbackOff()
    made.SetFlatOutput(flat)
    return scene.updated(made)


def column(mesh, k, method, name):
    left, right = k / len(CHARTS), (k + 1) / len(CHARTS)
    flat = laid_out(mesh, method, True)
    stretch = flat.GetOutputDataObject(2).GetValueByName(0, "MeanStretch").ToDouble()
    flips = flat.GetOutputDataObject(2).GetValueByName(0, "FlippedTriangles").ToInt()
    chart = scene.renderer([stretched(flat.GetOutputDataObject(0)), scene.actor(flat.GetOutputDataObject(1), scene.INK, 2)],
                           (left, 0.5, right, 1), 0.92, True)
    chart.AddActor(scene.label(f"{name}: stretch {stretch:.2f}", 0.04, 0.03, 14))
    if flips > 0:
        nothing = scene.renderer([], (left, 0, right, 0.5))
        nothing.AddActor(scene.label(f"no face: {flips} triangles flipped", 0.04, 0.5, 14))
        return [chart, nothing]
    face = knotwork.vtkTrimmedSurface()
    face.SetInputDataObject(laid_out(mesh, method, False).GetOutputDataObject(0))
    face.SetTolerance(3e-3 * mesh.GetLength())
    face.SetMargin(0.1)
    face = scene.updated(face)
    part = scene.actor(face.GetOutputDataObject(0), ORANGE, lighting=True)
    shown = scene.renderer([surface_actor(face)[0], part, curves(face)], (left, 0, right, 0.5), flat=False)
    shown.ResetCamera(mesh.GetBounds())
    points, share = int(number(face, "ControlPoints")), number(face, "MaxDeviation") / mesh.GetLength()
    shown.AddActor(scene.label(f"{points} control points, deviation below {100 * share:.2g} %", 0.04, 0.03, 14))
    return [chart, shown]


def main():
    mesh = scene.triangle_mesh(*scene.read_off("nefertiti.off"))
    panels = [panel for k, (method, name) in enumerate(CHARTS) for panel in column(mesh, k, method, name)]
    scene.save(panels, os.path.join(scene.output_folder(), "chart_faces.png"), (1200, 760))


if __name__ == "__main__":
    main()
