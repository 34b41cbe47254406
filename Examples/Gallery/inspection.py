# SPDX-License-Identifier: BSD-3-Clause
"""Inspection of a scanned part: moved to the coordinate system of three of its surfaces; its deviations from the CAD model, both ways.

The part is the joint of Debian's libcgal-demo; its scan is its CAD model in small triangles, one side bulged and one end worn.

usage: inspection.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersGeneral import vtkTransformFilter
from vtkmodules.vtkRenderingAnnotation import vtkAxesActor, vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkMapper

import _scene as scene

TYPES = ((0.72, 0.83, 0.92), (0.95, 0.73, 0.35), (0.36, 0.70, 0.55), (0.95, 0.90, 0.45), (0.86, 0.45, 0.30), (0.70, 0.70, 0.70))
DATUM = (0.84, 0.37, 0.0)


def turned(view, direction, up, zoom):
    camera = view.GetActiveCamera()
    camera.SetPosition(*(np.array(camera.GetFocalPoint()) + direction))
    camera.SetViewUp(*up)
    view.ResetCamera()
    camera.Zoom(zoom)
    return view


def axes(size):
    result = vtkAxesActor()
    result.SetTotalLength(size, size, size)
    result.SetShaftTypeToCylinder()
    for caption in (result.GetXAxisCaptionActor2D(), result.GetYAxisCaptionActor2D(), result.GetZAxisCaptionActor2D()):
        text = caption.GetCaptionTextProperty()
        text.SetColor(*scene.INK)
        text.ShadowOff()
        text.ItalicOff()
        caption.GetTextActor().SetTextScaleModeToNone()
        text.SetFontSize(16)
    return result


def regions_of(mesh):
    recognition = knotwork.vtkSurfaceRecognition()
    recognition.SetInputDataObject(mesh)
    scene.updated(recognition)
    table = recognition.GetOutputDataObject(2)
    rows = [{table.GetColumnName(c): table.GetValue(r, c) for c in range(table.GetNumberOfColumns())} for r in range(table.GetNumberOfRows())]
    return recognition.GetOutputDataObject(0), recognition.GetOutputDataObject(1), [row["Type"].ToString() for row in rows]


def datums(mesh, size):
    """The part at its place with its datums marked, and in their coordinate system."""
    triangles, edges, types = regions_of(mesh)
    plane = types.index("plane")
    hole = [r for r, word in enumerate(types) if word == "cylinder"][0]
    side = next(r for r in range(plane + 1, len(types)) if types[r] == "plane" and aligned(mesh, plane, r, hole))
    alignment = aligned(mesh, plane, side, hole)
    colours = [TYPES[["plane", "cylinder", "sphere", "cone", "torus", "free form"].index(word)] for word in types]
    for region in (plane, side, hole):
        colours[region] = tuple(0.55 * np.array(DATUM) + 0.45 * np.array(colours[region]))
    print("datums: plane", plane, "axis", side, "point", hole, "of", len(types), "regions")
    matrix = vtk_to_numpy(alignment.GetOutputDataObject(0).GetFieldData().GetArray("Motion"))[0]
    transform = vtkTransform()
    transform.SetMatrix(matrix)
    panels = []
    for k, motion in enumerate((None, transform)):
        parts = []
        for data in (triangles, edges):
            if motion:
                mover = vtkTransformFilter()
                mover.SetTransform(motion)
                mover.SetInputData(data)
                data = scene.updated(mover).GetPolyDataOutput()
            parts.append(data)
        lines = scene.actor(parts[1], scene.INK, line_width=2)
        lines.GetMapper().SetRelativeCoincidentTopologyLineOffsetParameters(0, -8)
        view = scene.renderer([scene.coloured_cells(parts[0], "RegionId", colours), lines], (k / 2, 0, k / 2 + 0.5, 1))
        view.AddActor(axes(0.45 * size))
        panels.append(turned(view, ((1.0, -1.3, 0.9), (1.3, 1.0, 0.9))[k], (0, 0, 1), 1.1))
        view.AddViewProp(scene.label(("as scanned; datums in orange", "plane at z = 0, x across the second plane, origin on the axis")[k], 0.04, 0.03, 16))
    return panels


def aligned(mesh, plane, axis, point):
    """Moved by datums; None where these do not go together."""
    alignment = knotwork.vtkDatumAlignment()
    alignment.SetInputDataObject(mesh)
    alignment.SetDatumPlane(plane)
    alignment.SetDatumAxis(axis)
    alignment.SetDatumPoint(str(point))
    alignment.Update()
    if alignment.GetErrorCode():
        scene.errors.clear()
        return None
    return alignment


def colour_table(limit):
    table = vtkLookupTable()
    table.SetNumberOfTableValues(13)
    for i in range(13):
        share = i / 6 - 1
        end = np.array([0.8, 0.1, 0.1] if share > 0 else [0.1, 0.25, 0.75])
        table.SetTableValue(i, *(np.array([0.85, 0.87, 0.85]) * (1 - abs(share)) + end * abs(share)), 1)
    table.SetRange(-limit, limit)
    return table


def coloured(polydata, table):
    result = scene.actor(polydata, (1, 1, 1), lighting=True)
    mapper = result.GetMapper()
    mapper.ScalarVisibilityOn()
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("Distance")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    mapper.InterpolateScalarsBeforeMappingOn()
    return result


def deviations(mesh, size):
    part = knotwork.vtkAnalyticModel()
    part.SetInputDataObject(mesh)
    model = scene.updated(part).GetOutputDataObject(1)
    fine = knotwork.vtkDeviationMap()  # the model in small triangles
    fine.SetInputDataObject(mesh)
    fine.SetModelData(model)
    fine.SetSamples(40000)
    scan = scene.updated(fine).GetOutputDataObject(1)
    points = vtk_to_numpy(scan.GetPoints().GetData())
    low, high = points.min(axis=0), points.max(axis=0)
    middle = 0.5 * (low + high)
    outward = points - middle
    bulge = np.exp(-60 * (((points - (middle + (0.25 * size * np.array([1, -0.6, 0.3])))) / size)**2).sum(axis=1))
    wear = np.exp(-90 * (((points - (middle + (0.3 * size * np.array([-0.6, -0.7, 0.5])))) / size)**2).sum(axis=1))
    points += (0.03 * bulge - 0.03 * wear)[:, None] * outward
    limit = 0.006 * size
    alignment = knotwork.vtkRigidAlignment()
    mover = vtkTransformFilter()
    transform = vtkTransform()
    transform.RotateWXYZ(140, 1, 2, 3)
    transform.Translate(1, 2, 3)
    mover.SetTransform(transform)
    mover.SetOutputPointsPrecision(1)
    mover.SetInputData(scan)
    alignment.SetInputConnection(0, mover.GetOutputPort())
    alignment.SetTargetData(model)
    deviation = knotwork.vtkDeviationMap()
    deviation.SetInputConnection(0, alignment.GetOutputPort(0))
    deviation.SetModelData(model)
    scene.updated(deviation)
    percentiles = deviation.GetOutputDataObject(2)
    rows = [[percentiles.GetValue(r, c).ToDouble() for c in range(3)] for r in range(percentiles.GetNumberOfRows())]
    print("percent, scan to model, model to scan:", *("%g %.5f %.5f;" % tuple(row) for row in rows))
    table = colour_table(limit)
    panels = []
    for k, word in enumerate(("scan, by its distances from the model", "model, by its distances from the scan")):
        data = deviation.GetOutputDataObject(k)
        view = scene.renderer([coloured(data, table)], (0.45 * k, 0, 0.45 * (k + 1), 1))
        panels.append(turned(view, (1.0, -1.3, 0.9), (0, 0, 1), 0.95))
        view.AddViewProp(scene.label(word, 0.04, 0.03, 16))
    bar = vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle("Distance")
    bar.SetNumberOfLabels(3)
    bar.SetLabelFormat("%.3f")
    bar.SetPosition(0.15, 0.15)
    bar.SetWidth(0.6)
    bar.SetHeight(0.7)
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(*scene.INK)
        text.ShadowOff()
        text.ItalicOff()
        text.BoldOff()
    side = scene.renderer([], (0.9, 0, 1, 1))
    side.AddViewProp(bar)
    return [*panels, side]


def main():
    vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
    points, triangles = scene.read_off("joint.off")
    size = np.linalg.norm(np.ptp(points, axis=0))
    mesh = scene.triangle_mesh(points, triangles)
    folder = scene.output_folder()
    scene.save(datums(mesh, size), os.path.join(folder, "datum_alignment.png"), (1200, 480))
    scene.save(deviations(mesh, size), os.path.join(folder, "deviation_map.png"), (1200, 480))


if __name__ == "__main__":
    main()
