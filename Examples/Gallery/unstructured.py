# SPDX-License-Identifier: BSD-3-Clause
"""A ring of blocks as a mesh of quadrilaterals, the spline through its points, and the spline with the mesh as control cage
(unstructured.png); the mesh cut into grids of cells (mesh_patches.png); reflection lines before and after the tangent planes at
extraordinary points are made one (tangent_planes.png); a Klein bottle, which has one side only (klein_bottle.png).

usage: unstructured.py [--output DIR]
"""
import os
import tempfile

import _scene as scene
import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkGlyph3D, vtkTubeFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper


def ring(n):
    """The surface of eight blocks around a hole, n x n quadrilaterals on every square, rounded."""
    def is_in(x, y, z):
        return 0 <= x < 3 * n and 0 <= y < 3 * n and 0 <= z < n and not (n <= x < 2 * n and n <= y < 2 * n)

    numbers, faces = {}, []
    cells = [c for c in np.ndindex(3 * n, 3 * n, n) if is_in(*c)]
    for cell in cells:
        for axis in range(3):
            for step in (-1, 1):
                beside = list(cell)
                beside[axis] += step
                if is_in(*beside):
                    continue
                a, b = (axis + 1) % 3, (axis + 2) % 3
                corners = [(0, 0), (1, 0), (1, 1), (0, 1)][::step]
                face = []
                for i, j in corners:
                    key = list(cell)
                    key[axis] += step > 0
                    key[a] += i
                    key[b] += j
                    face.append(numbers.setdefault(tuple(key), len(numbers)))
                faces.append(face)
    points = np.array(list(numbers), float) / n - (1.5, 1.5, 0.5)
    sides = np.array([(face[k], face[k - 1]) for face in faces for k in range(4)])
    for _ in range(6):  # every point to the mean of its neighbours
        sums = np.zeros_like(points)
        np.add.at(sums, sides[:, 0], points[sides[:, 1]])
        points = sums / np.bincount(sides[:, 0])[:, None]
    return points, faces


def klein_bottle(n, m):
    """n x m quadrilaterals; the last ring of them meets the first one turned over."""
    u, v = np.meshgrid(np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij")
    c, s, w = np.cos(u), np.sin(u), np.cos(v)
    x = -2 / 15 * c * (3 * w - 30 * s + 90 * c**4 * s - 60 * c**6 * s + 5 * c * w * s)
    y = -1 / 15 * s * ((3 - 3 * c**2 - 48 * c**4 + 48 * c**6) * w - 60 * s + (5 * c - 5 * c**3 - 80 * c**5 + 80 * c**7) * w * s)
    z = 2 / 15 * (3 + 5 * c * s) * np.sin(v)

    def number(i, j):
        return i * m + j % m if i < n else (m // 2 - j) % m

    faces = [[number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)] for i in range(n) for j in range(m)]
    return np.stack((x, y, z), -1).reshape(-1, 3), faces


def mesh_of(points, faces):
    mesh = vtkPolyData()
    vertices = vtkPoints()
    vertices.SetDataTypeToDouble()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    cells = vtkCellArray()
    for face in faces:
        cells.InsertNextCell(len(face), [int(i) for i in face])
    mesh.SetPoints(vertices)
    mesh.SetPolys(cells)
    return mesh


def spline(mesh, **properties):
    made = knotwork.vtkUnstructuredSpline()
    made.SetInputDataObject(mesh)
    for name, value in properties.items():
        getattr(made, "Set" + name)(value)
    return scene.updated(made)


def drawn(splines, tolerance=1e-4):
    """Tessellated, with normals of the surface."""
    made = knotwork.vtkSplineTessellate()
    made.SetInputDataObject(splines)
    made.SetChordalTolerance(tolerance)
    made.NormalsOn()
    made.SplittingOff()
    return scene.updated(made).GetOutputDataObject(0)


def patches_of(splines):
    """Its tensor-product patches, which a file of patches has."""
    with tempfile.TemporaryDirectory() as folder:
        name = os.path.join(folder, "patches.xml")
        knotwork.write(splines, name)
        return knotwork.read(name)


def panel(items, k, text, count=3):
    shown = scene.renderer(items, (k / count, 0, (k + 1) / count, 1), 1.0, False)
    camera = shown.GetActiveCamera()
    camera.SetPosition(2.2, -3.4, 3.6)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetViewUp(0, 0, 1)
    shown.ResetCamera()
    camera.Zoom(1.08)
    shown.AddActor(scene.label(text, 0.04, 0.03, 14))
    return shown


def stripes(splines, view, across, count, tolerance):
    """Where the surface reflects black and white lines on a far wall, `across` which they follow each other; view points to the eye."""
    made = knotwork.vtkSplineTessellate()
    made.SetInputDataObject(splines)
    made.SetChordalTolerance(tolerance)
    made.SplittingOn()
    surface = scene.updated(made).GetOutputDataObject(0)
    normals = vtk_to_numpy(surface.GetPointData().GetNormals())
    view = np.array(view) / np.linalg.norm(view)
    mirrored = 2 * (normals @ view)[:, None] * normals - view
    shade = numpy_to_vtk(np.sin(count * np.arcsin(np.clip(mirrored @ across, -1, 1))), deep=1)
    shade.SetName("Shade")
    surface.GetPointData().SetScalars(shade)
    table = vtkLookupTable()
    table.SetNumberOfTableValues(2)
    table.SetTableValue(0, *scene.INK, 1)
    table.SetTableValue(1, 0.95, 0.95, 0.92, 1)
    table.SetTableRange(-1, 1)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    mapper.InterpolateScalarsBeforeMappingOn()
    made = vtkActor()
    made.SetMapper(mapper)
    made.GetProperty().SetLighting(False)
    return made


def reflections(mesh, planes, k):
    made = spline(mesh, Degree=2, TangentPlanes=planes)
    angle = made.GetOutputDataObject(1).GetValueByName(0, "MaxNormalAngle").ToDouble()
    shown = scene.renderer([stripes(made.GetOutputDataObject(0), (2.2, -3.4, 3.6), (1, 0, 0), 36, 2e-6)], (k / 2, 0, (k + 1) / 2, 1), 1.0, False)
    camera = shown.GetActiveCamera()  # an extraordinary point of five cells at the hole
    camera.SetFocalPoint(-0.42, 0.42, 0.35)
    camera.SetPosition(0.6, -1.5, 3.2)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(20)
    shown.ResetCameraClippingRange()
    shown.AddActor(scene.label(f"up to {angle:.1f} degrees", 0.4, 0.07, 14))
    return shown


def cut(mesh, layout, k):
    """The patches of a mesh, the cuts as lines, T-joints as balls."""
    made = knotwork.vtkMeshPatches()
    made.SetInputDataObject(mesh)
    made.SetLayout(layout)
    scene.updated(made)
    surface = vtkPolyData()
    surface.ShallowCopy(mesh)
    surface.GetCellData().ShallowCopy(made.GetOutputDataObject(0).GetCellData())
    faces = scene.patches(surface, "PatchId", True)
    faces.GetProperty().SetEdgeVisibility(1)
    faces.GetProperty().SetEdgeColor(0.8, 0.8, 0.8)
    cuts = made.GetOutputDataObject(1)
    lines = vtkTubeFilter()
    lines.SetInputDataObject(cuts)
    lines.SetRadius(0.012)
    lines.SetNumberOfSides(10)
    items = [faces, scene.actor(scene.updated(lines).GetOutputDataObject(0), scene.INK, lighting=True)]
    joints = vtkPolyData()
    joints.SetPoints(vtkPoints())
    for i in range(cuts.GetNumberOfVerts()):
        joints.GetPoints().InsertNextPoint(cuts.GetCell(i).GetPoints().GetPoint(0))
    if cuts.GetNumberOfVerts() > 0:
        ball = vtkSphereSource()
        ball.SetRadius(0.045)
        glyphs = vtkGlyph3D()
        glyphs.SetInputDataObject(joints)
        glyphs.SetSourceConnection(ball.GetOutputPort())
        glyphs.ScalingOff()
        items.append(scene.actor(scene.updated(glyphs).GetOutputDataObject(0), (0.85, 0.1, 0.1), lighting=True))
    count = made.GetOutputDataObject(2).GetNumberOfRows()
    return panel(items, k, f"{count} patches along {'tracks' if k else 'the base complex'}", 2)


def bottle(folder):
    mesh = mesh_of(*klein_bottle(36, 16))
    made = spline(mesh, Degree=3)
    functions = made.GetOutputDataObject(1).GetValueByName(0, "Functions").ToInt()
    cells = scene.actor(mesh, (0.95, 0.93, 0.88), lighting=True)
    cells.GetProperty().SetEdgeVisibility(1)
    cells.GetProperty().SetEdgeColor(*scene.INK)
    surface = drawn(made.GetOutputDataObject(0), 1e-5)
    smooth = scene.actor(surface, scene.COLOURS[0], opacity=0.55, lighting=True)
    smooth.GetProperty().SetSpecular(0.3)
    smooth.GetProperty().SetSpecularPower(30)
    shown = []
    for k, (item, text) in enumerate(((cells, f"{mesh.GetNumberOfCells()} quadrilaterals"), (smooth, f"degree 3, {functions} functions"))):
        shown.append(scene.renderer([item], (k / 2, 0, (k + 1) / 2, 1), 1.0, False))
        camera = shown[-1].GetActiveCamera()
        camera.SetFocalPoint(0, 2, 0)
        camera.SetPosition(-7, 4.5, 12)
        camera.SetViewUp(0, 1, 0)
        shown[-1].ResetCamera()
        camera.Zoom(1.3)
        shown[-1].AddActor(scene.label(text, 0.04, 0.03, 14))
    scene.save(shown, os.path.join(folder, "klein_bottle.png"), (900, 520))


def main():
    folder = scene.output_folder()
    bottle(folder)
    mesh = mesh_of(*ring(3))
    scene.save([cut(mesh, "base-complex", 0), cut(mesh, "motorcycle-graph", 1)], os.path.join(folder, "mesh_patches.png"), (900, 420))
    scene.save([reflections(mesh, False, 0), reflections(mesh, True, 1)], os.path.join(folder, "tangent_planes.png"), (1000, 440))
    through = spline(mesh, Degree=3).GetOutputDataObject(0)
    cage = spline(mesh, Degree=3, Construction="control-cage").GetOutputDataObject(0)
    cells = scene.actor(mesh, (0.95, 0.93, 0.88), lighting=True)
    cells.GetProperty().SetEdgeVisibility(1)
    cells.GetProperty().SetEdgeColor(*scene.INK)
    panels = [panel([cells], 0, f"{mesh.GetNumberOfCells()} quadrilaterals"),
              panel([scene.patches(drawn(patches_of(through)), "PatchId", True)], 1, "through the points, patches in colours"),
              panel([scene.actor(drawn(cage), scene.COLOURS[0], lighting=True)], 2, "the mesh as control cage")]
    scene.save(panels, os.path.join(folder, "unstructured.png"), (1200, 420))


if __name__ == "__main__":
    main()
