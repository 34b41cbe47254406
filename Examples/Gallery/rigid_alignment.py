# SPDX-License-Identifier: BSD-3-Clause
"""A scan of a machined part, with noise and stray points, far from its CAD model; the same on it, in the colours of its distances.

The part is a coupling of Debian's libcgal-demo, made a CAD model.

usage: rigid_alignment.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersGeneral import vtkVertexGlyphFilter
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkMapper

import _scene as scene

POINTS, STRAY = 6000, 600
NOISE = 1.5e-3  # of the size
LIMIT = 4.5e-3  # of the colours, the same


def points_on(points, triangles, count, random):
    corners = points[triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = corners[random.choice(len(triangles), count, p=areas / areas.sum())]
    b, c = random.random(count), random.random(count)
    b, c = np.where(b + c > 1, 1 - b, b)[:, None], np.where(b + c > 1, 1 - c, c)[:, None]
    return chosen[:, 0] + b * (chosen[:, 1] - chosen[:, 0]) + c * (chosen[:, 2] - chosen[:, 0])


def scan_of(points, triangles, size, random):
    """Points with noise, and stray ones, turned and shifted."""
    cloud = points_on(points, triangles, POINTS, random)
    cloud += NOISE * size * random.normal(size=cloud.shape)
    cloud = np.r_[cloud, random.uniform(points.min(axis=0), points.max(axis=0), (STRAY, 3))]
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    turn[:, 0] *= np.linalg.det(turn)
    return (cloud - cloud.mean(axis=0)) @ turn.T + points.mean(axis=0) + np.array([0.75, -0.75, 0.1]) * size


def dots(cloud):
    """An actor of points."""
    vertices = vtkVertexGlyphFilter()
    vertices.SetInputData(cloud)
    result = scene.actor(scene.updated(vertices).GetOutput(), (0.84, 0.37, 0.0))
    result.GetProperty().SetPointSize(3)
    return result


def coloured(dotted, limit):
    """The same in the colours of Distance: blue inside, red outside."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(11)
    for i in range(11):
        share = i / 5 - 1
        table.SetTableValue(i, *(np.array([0.8, 0.82, 0.8]) * (1 - abs(share)) + np.array([0.8, 0.1, 0.1] if share > 0 else [0.1, 0.25, 0.75]) * abs(share)), 1)
    table.SetRange(-limit, limit)
    mapper = dotted.GetMapper()
    mapper.SetRelativeCoincidentTopologyPointOffsetParameter(-15000)  # points inside are seen too
    mapper.ScalarVisibilityOn()
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("Distance")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    bar = vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle("Distance")
    bar.SetNumberOfLabels(3)
    bar.SetLabelFormat("%.3f")
    bar.SetPosition(0.86, 0.12)
    bar.SetWidth(0.1)
    bar.SetHeight(0.6)
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(*scene.INK)
        text.ShadowOff()
        text.ItalicOff()
        text.BoldOff()
    return dotted, bar


def main():
    vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
    random = np.random.default_rng(5)
    points, triangles = scene.read_off("couplingdown.off")
    size = np.linalg.norm(np.ptp(points, axis=0))
    model = knotwork.vtkAnalyticModel()
    model.SetInputDataObject(scene.triangle_mesh(points, triangles))
    part = scene.updated(model)
    cloud = scene.triangle_mesh(scan_of(points, triangles, size, random), [])
    alignment = knotwork.vtkRigidAlignment()
    alignment.SetInputDataObject(cloud)
    alignment.SetTargetData(part.GetOutputDataObject(1))
    numbers = scene.updated(alignment).GetOutputDataObject(1)
    print(", ".join(f"{numbers.GetColumnName(i)} {numbers.GetValue(0, i).ToString()}" for i in range(numbers.GetNumberOfColumns())))
    aligned = alignment.GetOutputDataObject(0)
    faces = part.GetOutputDataObject(0)
    distance = vtk_to_numpy(aligned.GetPointData().GetArray("Distance"))
    near = scene.triangle_mesh(vtk_to_numpy(aligned.GetPoints().GetData())[np.abs(distance) < 2 * LIMIT * size], [])
    near.GetPointData().AddArray(scene.numpy_to_vtk(distance[np.abs(distance) < 2 * LIMIT * size], deep=1))
    near.GetPointData().GetArray(0).SetName("Distance")
    before = scene.renderer([scene.actor(faces, (0.62, 0.70, 0.80), lighting=True), dots(cloud)], (0, 0, 0.5, 1))
    colours, bar = coloured(dots(near), LIMIT * size)
    colours.GetProperty().SetPointSize(3)
    after = scene.renderer([scene.actor(faces, (0.62, 0.70, 0.80), lighting=True), colours], (0.5, 0, 1, 1))
    for view, zoom in ((before, 1.25), (after, 1.3)):
        camera = view.GetActiveCamera()
        camera.SetPosition(*(np.array(camera.GetFocalPoint()) + (-1.0, -0.6, -1.2)))
        camera.SetViewUp(0, 0, -1)
        view.ResetCamera()
        camera.Zoom(zoom)
    before.AddViewProp(scene.label("scan with noise and stray points, and CAD model", 0.04, 0.03, 16))
    after.AddViewProp(scene.label(f"{numbers.GetValueByName(0, 'Iterations').ToInt()} iterations later, stray points left out", 0.04, 0.03, 16))
    after.AddViewProp(bar)
    scene.save([before, after], os.path.join(scene.output_folder(), "rigid_alignment.png"), (1200, 480))


if __name__ == "__main__":
    main()
