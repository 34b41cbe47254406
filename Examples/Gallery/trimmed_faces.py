# SPDX-License-Identifier: BSD-3-Clause
"""Triangle meshes that become trimmed spline faces (trimmed_faces.png), and what continues a surface where there is no mesh
(back_maps.png).

A bust of Debian's libcgal-demo, whose eyes and mouth are cut out here, and a CAD patch: the mesh, the mesh in the plane with its loops,
the surface over its rectangle with the trimmed part in orange, the face. Then an S on a cone that is made here: surfaces by the published NURBS method, by the
hybrid of radial basis functions and splines, and by penalized least squares; what is folded is red.
"""
import os

import _scene as scene
import knotwork
import numpy as np
from flat_meshes import s_on_cone
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

ORANGE, GREY, RED = (0.93, 0.55, 0.15), (0.80, 0.84, 0.88), (0.80, 0.05, 0.15)


def flattened(mesh, flat=False):
    result = knotwork.vtkMeshParameterization()
    result.SetInputDataObject(mesh)
    result.SetFlatOutput(flat)
    return scene.updated(result)


def trimmed(mesh, method="PENALIZED", tolerance=0.0, elements=0):
    result = knotwork.vtkTrimmedSurface()
    result.SetInputDataObject(flattened(mesh).GetOutputDataObject(0))
    result.SetMethod(getattr(result, method))
    result.SetTolerance(tolerance)
    result.SetElements(elements)
    result.SetMargin(0.1)
    return scene.updated(result)


def lattice(face, n):
    """Points of the surface at n x n parameters, quadrilaterals between them."""
    bounds = vtk_to_numpy(face.GetOutputDataObject(1).GetCellData().GetArray("ParametricBounds"))
    u, v = np.meshgrid(np.linspace(bounds[:, 0].min(), bounds[:, 1].max(), n),
                       np.linspace(bounds[:, 2].min(), bounds[:, 3].max(), n))
    queries = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.c_[u.ravel(), v.ravel(), np.zeros(n * n)], deep=1))
    queries.SetPoints(points)
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputDataObject(0, face.GetOutputDataObject(1))
    evaluate.SetInputDataObject(1, queries)
    return vtk_to_numpy(scene.updated(evaluate).GetOutputDataObject(0).GetPoints().GetData()).reshape(n, n, 3)


def folded(points):
    """Of the quadrilaterals of a lattice: the normal turns by more than a right angle to a neighbour."""
    normals = np.cross(points[1:, 1:] - points[:-1, :-1], points[1:, :-1] - points[:-1, 1:])
    normals /= np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), 1e-300)
    turns = np.zeros(normals.shape[:2], bool)
    for axis in (0, 1):
        first, second = [slice(None)] * 2, [slice(None)] * 2
        first[axis], second[axis] = slice(None, -1), slice(1, None)
        bad = (normals[tuple(first)] * normals[tuple(second)]).sum(2) < 0
        turns[tuple(first)] |= bad
        turns[tuple(second)] |= bad
    return turns


def surface_actor(face, n=240):
    """The whole surface, grey, and red where it is folded; with the share that is."""
    points = lattice(face, n)
    turns = folded(points)
    mesh = vtkPolyData()
    vertices = vtkPoints()
    vertices.SetDataTypeToDouble()
    vertices.SetData(numpy_to_vtk(points.reshape(-1, 3), deep=1))
    a = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    cells = vtkCellArray()
    cells.SetData(4, numpy_to_vtk(np.c_[a, a + 1, a + n + 1, a + n].ravel().astype(np.int64), deep=1,
                                  array_type=cells.GetConnectivityArray().GetDataType()))
    mesh.SetPoints(vertices)
    mesh.SetPolys(cells)
    colours = np.where(turns.ravel()[:, None], RED, GREY)
    mesh.GetCellData().SetScalars(numpy_to_vtk((255 * colours).round().astype(np.uint8), deep=1))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(mesh)
    mapper.SetScalarModeToUseCellData()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(4, 400)  # behind the trimmed part
    actor = vtkActor()
    actor.SetMapper(mapper)
    scene.soften(actor)
    return actor, turns.mean()


def curves(face):
    """The trimming curves in space."""
    lines = knotwork.vtkSplineTessellate()
    lines.SetInputDataObject(face.GetOutputDataObject(2))
    return scene.actor(scene.updated(lines).GetOutputDataObject(0), scene.INK, 2)


def wire(mesh, lighting):
    actor = scene.actor(mesh, (1, 0.97, 0.9), lighting=lighting)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.5, 0.5, 0.5)
    return actor


def number(face, name):
    return face.GetOutputDataObject(4).GetValueByName(0, name).ToDouble()


def aimed(shown, direction, up, zoom=1.0):
    """The renderer, seen from a direction."""
    if direction is not None:
        camera = shown.GetActiveCamera()
        camera.SetFocalPoint(0, 0, 0)
        camera.SetPosition(*direction)
        camera.SetViewUp(*up)
        shown.ResetCamera()
        camera.Zoom(zoom)
    return shown


def row(mesh, bottom, top, direction, up):
    """Mesh, plane, surface, face from left to right."""
    face = trimmed(mesh, tolerance=3e-3 * mesh.GetLength())
    flat = flattened(mesh, flat=True)
    triangles = face.GetOutputDataObject(0)
    plane = scene.renderer([wire(flat.GetOutputDataObject(0), False), scene.actor(flat.GetOutputDataObject(1), (0.8, 0.1, 0.1), 3)],
                           (0.25, bottom, 0.5, top), 1.0, True)
    panels = [aimed(scene.renderer([wire(mesh, True)], (0, bottom, 0.25, top), flat=False), direction, up), plane]
    part = scene.actor(triangles, ORANGE, lighting=True)
    panels.append(aimed(scene.renderer([surface_actor(face)[0], part, curves(face)], (0.5, bottom, 0.75, top), flat=False),
                        direction, up))
    panels.append(aimed(scene.renderer([scene.actor(triangles, ORANGE, lighting=True), curves(face)], (0.75, bottom, 1, top),
                                       flat=False), direction, up))
    loops, relative = int(number(face, "Loops")), number(face, "MaxDeviation") / mesh.GetLength()
    panels[0].AddActor(scene.label(f"{mesh.GetNumberOfCells()} triangles", 0.04, 0.03, 14))
    plane.AddActor(scene.label(f"{loops} loop{'s' if loops > 1 else ''}", 0.04, 0.03, 14))
    panels[2].AddActor(scene.label(f"{int(number(face, 'ControlPoints'))} control points", 0.04, 0.03, 14))
    panels[3].AddActor(scene.label(f"deviation below {100 * relative:.2g} % of the diagonal", 0.04, 0.03, 14))
    return panels


def without(mesh_arrays, places):
    """Points and triangles without those in ellipses; x, y and half axes as shares of the box."""
    points, triangles = mesh_arrays
    centres = (points[triangles].mean(1) - points.min(0)) / np.ptp(points, axis=0)
    keep = np.ones(len(triangles), bool)
    for x, y, a, b in places:
        keep &= ((centres[:, 0] - x) / a)**2 + ((centres[:, 1] - y) / b)**2 > 1
    used, cells = np.unique(triangles[keep], return_inverse=True)
    return points[used], cells.reshape(-1, 3)


def bust():
    """Points and triangles of a bust whose eyes and mouth are holes."""
    features = ((0.27, 0.66, 0.11, 0.045), (0.73, 0.66, 0.11, 0.045), (0.51, 0.21, 0.13, 0.05))
    return without(scene.read_off("nefertiti.off"), features)


def main():
    folder = scene.output_folder()
    panels = row(scene.triangle_mesh(*bust()), 0.5, 1, None, None)
    panels += row(scene.triangle_mesh(*scene.read_off("patch-30.off")), 0, 0.5, (1, -1.4, 1), (0, 0, 1))
    scene.save(panels, os.path.join(folder, "trimmed_faces.png"), (1200, 640))

    letter = s_on_cone()
    panels = []
    for k, (method, name) in enumerate((("NURBS", "NURBS, as published"), ("CONTINUED_LINES", "continued lines"), ("HYBRID", "hybrid"),
                                      ("PENALIZED", "penalized"))):
        face = trimmed(letter, method, elements=40)
        actor, share = surface_actor(face)
        shown = scene.renderer([actor, scene.actor(face.GetOutputDataObject(0), ORANGE, lighting=True), curves(face)],
                               (k / 4, 0, (k + 1) / 4, 1), flat=False)
        shown.AddActor(scene.label(f"{name}: {100 * share:.2g} % folded", 0.04, 0.03, 14))
        aimed(shown, (6, 0, 2), (0, 0, 1)).ResetCamera(letter.GetBounds())  # extrapolation goes far
        panels.append(shown)
    scene.save(panels, os.path.join(folder, "back_maps.png"), (1400, 380))


if __name__ == "__main__":
    main()
