# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of real parts as splines: reflection lines of a sheet-metal panel of 15,188 quadrilaterals around an extraordinary point, as
it is and with one tangent plane there (panel.png); a rod of genus 2, a mesh made from a scan, read back from the STEP solid that it
was written to (rod.png); a place of it where cells are folded, and the splines of the mesh as it is and untangled (untangled.png);
hexahedra of a machine part, cut along their base complex (hexahedra.png).

The folder of the meshes is named by KNOTWORK_UNSTRUCTURED_MESHES.

usage: meshed_parts.py [--output DIR]
"""
import os
import tempfile

import _scene as scene
import knotwork
import numpy as np
import unstructured
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkThreshold
from vtkmodules.vtkFiltersGeneral import vtkTransformFilter
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

# An extraordinary point of five quadrilaterals of the panel, and what the reflection lines there are seen along and across.
POINT = np.array((3069.128662, -277.844818, -946.50061))
NORMAL = np.array((0.068, 0.387, -0.92))
ACROSS = np.array((-0.997, 0.0, -0.074))

# A folded quadrilateral of the rod, and how it is seen.
FOLDED = 368
FOLDED_SEEN = np.array((0.118, -0.101, 0.988))
FOLDED_UP = (-0.575, 0.202, 0.09)

FOLDER = os.environ.get("KNOTWORK_UNSTRUCTURED_MESHES", "")


def read(name):
    path = os.path.join(FOLDER, name)
    if not FOLDER or not os.path.exists(path):
        scene.leave_out(f"{name} is missing: KNOTWORK_UNSTRUCTURED_MESHES names the folder of the meshes")
    return knotwork.read(path)


def camera(shown, focus, direction, up, height):
    """Looks at a point along a direction; what is as high as `height` fills the view."""
    made = shown.GetActiveCamera()
    made.ParallelProjectionOn()
    made.SetFocalPoint(*focus)
    made.SetPosition(*(np.array(focus) + 10 * height * np.array(direction)))
    made.SetViewUp(*up)
    made.SetParallelScale(height / 2)
    shown.ResetCameraClippingRange()
    return shown


def panel(folder):
    mesh = read("gs_neon_side.off")
    shown = []
    for planes in (False, True):
        made = unstructured.spline(mesh, Degree=2, TangentPlanes=planes).GetOutputDataObject(0)
        if not planes:
            body = scene.actor(unstructured.drawn(made, 1e-5), scene.COLOURS[0], lighting=True)
            shown.append(camera(scene.renderer([body], (0, 0, 0.44, 1)), mesh.GetCenter(), (0.15, -0.1, -1), (0, 1, 0), 1950))
            text = f"{mesh.GetNumberOfCells()} quadrilaterals, degree 2; around a point of five:\nas it is, and with one tangent plane"
            shown[-1].AddActor(scene.label(text, 0.04, 0.03, 14))
        item = unstructured.stripes(made, NORMAL, ACROSS, 60, 2e-7)
        left = 0.444 + 0.28 * planes
        shown.append(camera(scene.renderer([item], (left, 0, left + 0.276, 1)), POINT, NORMAL, (0, 1, 0), 80))
    scene.save(shown, os.path.join(folder, "panel.png"), (1600, 440))


def rod(folder):
    mesh = read("bl_rod_764.off")
    made = unstructured.spline(mesh, Degree=2)
    functions = made.GetOutputDataObject(1).GetValueByName(0, "Functions").ToInt()
    with tempfile.TemporaryDirectory() as place:
        name = os.path.join(place, "rod.step")
        knotwork.write(made.GetOutputDataObject(0), name)
        faces = knotwork.read(name)
    cells = scene.actor(mesh, (0.95, 0.93, 0.88), lighting=True)
    cells.GetProperty().SetEdgeVisibility(1)
    cells.GetProperty().SetEdgeColor(*scene.INK)
    drawn = unstructured.drawn(faces)
    count = len(np.unique(vtk_to_numpy(drawn.GetCellData().GetArray("PatchId"))))
    items = ((cells, f"{mesh.GetNumberOfCells()} quadrilaterals from a scan"),
             (scene.patches(drawn, "PatchId", True), f"a STEP solid of {count} faces, {functions} functions"))
    shown = []
    for k, (item, text) in enumerate(items):
        shown.append(camera(scene.renderer([item], (k / 2, 0, (k + 1) / 2, 1)), mesh.GetCenter(), (0.25, -1, 0.8), (0, 0, 1), 11))
        shown[-1].AddActor(scene.label(text, 0.04, 0.03, 14))
    scene.save(shown, os.path.join(folder, "rod.png"), (1100, 330))


def untangled(folder):
    mesh = read("bl_rod_764.off")
    focus = np.mean([mesh.GetPoint(mesh.GetCell(FOLDED).GetPointId(k)) for k in range(4)], 0)
    cells = scene.actor(mesh, (0.95, 0.93, 0.88), lighting=True)
    cells.GetProperty().SetEdgeVisibility(1)
    cells.GetProperty().SetEdgeColor(*scene.INK)
    items = [(cells, "quadrilaterals, some of them folded")]
    for untangle, text in (("off", "the spline of degree 3 through their points"), ("elements", "the spline of the untangled mesh")):
        made = unstructured.spline(mesh, Degree=3, Untangle=untangle)
        items.append((scene.patches(unstructured.drawn(made.GetOutputDataObject(0), 1e-5), "ElementId", True), text))
    shown = []
    for k, (item, text) in enumerate(items):
        shown.append(camera(scene.renderer([item], (k / 3, 0, (k + 1) / 3, 1)), focus, FOLDED_SEEN, FOLDED_UP, 3.2))
        shown[-1].AddActor(scene.label(text, 0.04, 0.03, 14))
    scene.save(shown, os.path.join(folder, "untangled.png"), (1200, 400))


def hexahedra(folder):
    mesh = read("cmu_hepta.vtk")
    made = knotwork.vtkMeshPatches()
    made.SetInputDataObject(mesh)
    cells = scene.updated(made).GetOutputDataObject(0)
    count = made.GetOutputDataObject(2).GetNumberOfRows()
    shown = []
    for k, text in enumerate((f"{mesh.GetNumberOfCells()} hexahedra", f"{count} patches of the base complex, moved apart")):
        pieces = vtkAppendPolyData()
        for patch in range(count):
            one = vtkThreshold()
            one.SetInputDataObject(cells)
            one.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "PatchId")
            one.SetLowerThreshold(patch)
            one.SetUpperThreshold(patch)
            outer = vtkDataSetSurfaceFilter()
            outer.SetInputConnection(one.GetOutputPort())
            apart = vtkTransform()
            scene.updated(outer)
            apart.Translate(0.5 * k * (np.array(outer.GetOutput().GetCenter()) - mesh.GetCenter()))
            moved = vtkTransformFilter()
            moved.SetTransform(apart)
            moved.SetInputConnection(outer.GetOutputPort())
            pieces.AddInputConnection(moved.GetOutputPort())
        faces = scene.patches(scene.updated(pieces).GetOutput(), "PatchId", True)
        faces.GetProperty().SetEdgeVisibility(1)
        faces.GetProperty().SetEdgeColor(0.8, 0.8, 0.8)
        shown.append(camera(scene.renderer([faces], (k / 2, 0, (k + 1) / 2, 1)), mesh.GetCenter() - np.array((0, 0, 6)), (0.8, -1, 0.7), (0, 0, 1), 195))
        shown[-1].AddActor(scene.label(text, 0.04, 0.03, 14))
    scene.save(shown, os.path.join(folder, "hexahedra.png"), (900, 460))


def main():
    folder = scene.output_folder()
    panel(folder)
    rod(folder)
    untangled(folder)
    hexahedra(folder)


if __name__ == "__main__":
    main()
