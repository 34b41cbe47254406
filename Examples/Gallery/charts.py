# SPDX-License-Identifier: BSD-3-Clause
"""Closed meshes cut into charts, and the charts in the plane (charts.png).

An elephant and a coupling of Debian's libcgal-demo. Above the mesh, below its charts side by side, in the same colours.
"""
import os

import _scene as scene
import knotwork

MESHES = (("elephant.off", (0.5, -0.4, 1), (0, 1, 0)), ("couplingdown.off", (0.4, -1, 0.9), (0, 0, 1)))


def charts(mesh, flat):
    parameterization = knotwork.vtkMeshParameterization()
    parameterization.SetInputDataObject(mesh)
    parameterization.SetMaximumStretch(2)
    parameterization.SetFlatOutput(flat)
    return scene.updated(parameterization)


def panel(mesh, viewport, flat, direction=None, up=None):
    result = charts(mesh, flat)
    loops = scene.actor(result.GetOutputDataObject(1), scene.INK, 2)
    shown = scene.renderer([scene.patches(result.GetOutputDataObject(0), "ChartId", not flat), loops], viewport, 1.1 if flat else 0.92, flat)
    if flat:
        table = result.GetOutputDataObject(2)
        count = table.GetValueByName(0, "Charts").ToInt()
        stretch = table.GetValueByName(0, "MaxStretch").ToDouble()
        shown.AddActor(scene.label(f"{count} charts, stretch up to {stretch:.2f}", 0.04, 0.03, 14))
    else:
        camera = shown.GetActiveCamera()
        centre = camera.GetFocalPoint()
        camera.SetPosition(*(c + d for c, d in zip(centre, direction)))
        camera.SetViewUp(*up)
        shown.ResetCamera()
        camera.Zoom(1.3)
    return shown


def main():
    folder = scene.output_folder()
    panels = []
    for k, (name, direction, up) in enumerate(MESHES):
        mesh = scene.triangle_mesh(*scene.read_off(name))
        left, right = k / len(MESHES), (k + 1) / len(MESHES)
        panels.append(panel(mesh, (left, 0.5, right, 1), False, direction, up))
        panels.append(panel(mesh, (left, 0, right, 0.5), True))
    scene.save(panels, os.path.join(folder, "charts.png"), (1200, 900))


if __name__ == "__main__":
    main()
