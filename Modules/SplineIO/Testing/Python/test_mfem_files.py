# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of MFEM from Python and from the command line: what becomes of each kind, its topology, periodic ones, what is refused."""
import json
import math

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import (VTK_BEZIER_HEXAHEDRON, VTK_BEZIER_QUADRILATERAL, VTK_BEZIER_TETRAHEDRON, VTK_BEZIER_TRIANGLE,
                                           VTK_BEZIER_WEDGE, VTK_QUAD, vtkGenericCell)


def path(name):
    return knotwork_testing.output("mfem/" + name)


def data(name):
    return knotwork_testing.data("SplineIO/" + name)


def written(name, text):
    with open(path(name), "w") as stream:
        stream.write(text)
    return path(name)


def report(*arguments):
    done = knotwork_testing.run_program(*arguments, "--report", path("report.json"))
    assert done.returncode == 0, (arguments, done.stderr)
    with open(path("report.json")) as stream:
        return json.load(stream)


def cell_array(grid, name):
    return vtk_to_numpy(grid.GetCellData().GetArray(name))


def spline_of(mesh, degree=3):
    made = knotwork.vtkUnstructuredSpline()
    made.SetInputDataObject(mesh)
    made.SetDegree(degree)
    made.Update()
    assert made.GetErrorCode() == 0
    return made


def refused(name, text, *words):
    try:
        knotwork.read(written(name, text))
    except ValueError as failure:
        assert all(word in str(failure) for word in (name,) + words), str(failure)
        return
    raise AssertionError(name)


def test_linear_cells():
    grid = knotwork.read(data("linear.mesh"))
    assert [grid.GetCellType(c) for c in range(grid.GetNumberOfCells())] == [VTK_QUAD] * 5
    assert list(cell_array(grid, "Attribute")) == [1, 2, 1, 2, 1]
    numbers = report("unstructured", data("linear.mesh"), "--degree", "2", "--output", path("star.vtu"))
    assert numbers["extraordinary_points"] == 1 and numbers["elements"] == 5


def test_a_disc_of_nurbs_has_the_area_of_the_circle():
    assert abs(report("validate", data("nurbs.mesh"))["measure"] - math.pi) < 1e-13
    grid = knotwork.read(data("nurbs.mesh"))
    sides = vtk_to_numpy(grid.GetFieldData().GetArray("KnotworkInterfaces"))
    assert len(sides) == 8 and len(vtk_to_numpy(grid.GetFieldData().GetArray("KnotworkBoundary"))) == 4
    assert [int(a) for a in cell_array(grid, "Attribute")] == [1 if p == 0 else 2 for p in cell_array(grid, "PatchId")]
    knotwork.write(grid, path("disc.xml"))
    assert abs(report("validate", path("disc.xml"))["measure"] - math.pi) < 1e-13


def test_a_klein_bottle_closes():
    grid = knotwork.read(data("curved.mesh"))
    assert grid.GetCellType(0) == VTK_BEZIER_QUADRILATERAL
    # 48 cells, 96 edges, 48 vertices have the points of degree 2; where the seam turns, nodes agree
    assert grid.GetNumberOfPoints() == 48 + 96 + 48
    for degree in (1, 2, 3):
        table = spline_of(grid, degree).GetOutputDataObject(1)
        assert table.GetValueByName(0, "Functions").ToInt() == 48 and table.GetValueByName(0, "Orientable").ToInt() == 0


def test_simplices_and_wedges_have_the_points_of_vtk():
    """One curved cell of each shape, evaluated by VTK, against the quadratic map whose nodes it has."""
    def curved(x):
        return np.array([x[0] + 0.2 * x[1] * x[1], x[1] - 0.1 * x[0] * x[2], x[2] + 0.3 * x[0] * x[1]])

    half = (0.0, 0.5, 1.0)
    shapes = {VTK_BEZIER_TRIANGLE: (2, 2, lambda x, y, z: z == 0 and x + y <= 1), VTK_BEZIER_TETRAHEDRON: (4, 3, lambda x, y, z: x + y + z <= 1),
              VTK_BEZIER_WEDGE: (6, 3, lambda x, y, z: x + y <= 1), VTK_BEZIER_HEXAHEDRON: (5, 3, lambda x, y, z: True)}
    corners = {2: 3, 4: 4, 6: 6, 5: 8}
    for kind, (number, dimension, inside) in shapes.items():
        nodes = [curved((x, y, z)) for z in half for y in half for x in half if inside(x, y, z)]
        text = (f"MFEM mesh v1.0\ndimension\n{dimension}\nelements\n1\n1 {number} {' '.join(map(str, range(corners[number])))}\nboundary\n0\n"
                f"vertices\n{corners[number]}\nnodes\nFiniteElementSpace\nFiniteElementCollection: L2_T1_{dimension}D_P2\nVDim: 3\nOrdering: 1\n"
                + "\n".join(" ".join("%.17g" % x for x in node) for node in nodes) + "\n")
        grid = knotwork.read(written("one.mesh", text))
        assert grid.GetCellType(0) == kind
        cell, at, weights = vtkGenericCell(), [0.0, 0.0, 0.0], [0.0] * 27
        grid.GetCell(0, cell)
        for place in ((0.2, 0.3, 0.1), (0.5, 0.1, 0.3), (0.1, 0.1, 0.6)):
            local = place[:dimension] + (0.0,) * (3 - dimension)
            cell.EvaluateLocation(mutable(0), local, at, weights)
            assert np.abs(curved(local) - at).max() < 1e-14, (number, at)


def test_a_vertex_at_two_places():
    """Three squares in a row that are a ring by their vertices: read, but no spline of one place a vertex."""
    cells = "1 3 0 1 4 3\n1 3 1 2 5 4\n1 3 2 0 3 5"
    nodes = "\n".join(f"{x + a} {b}" for x in range(3) for b in (0, 1) for a in (0, 1))
    text = (f"MFEM mesh v1.0\ndimension\n2\nelements\n3\n{cells}\nboundary\n0\nvertices\n6\nnodes\nFiniteElementSpace\n"
            f"FiniteElementCollection: L2_T1_2D_P1\nVDim: 2\nOrdering: 1\n{nodes}\n")
    name = written("ring.mesh", text)
    assert knotwork.read(name).GetNumberOfPoints() == 8
    done = knotwork_testing.run_program("unstructured", name, "--output", path("ring.vtu"))
    assert done.returncode == 1 and len(done.stderr.strip().splitlines()) == 1
    assert all(word in done.stderr for word in ("ring.mesh", "cell 2 has vertex 0 at (3, 0, 0)", "cut it open")), done.stderr


def test_damaged_vertices_of_cells():
    def message(change):
        grid = knotwork.read(data("curved.mesh"))
        change(grid.GetCellData().GetArray("MeshVertices"))
        made = knotwork.vtkUnstructuredSpline()
        made.SetInputDataObject(grid)
        with knotwork_testing.Errors(made) as errors:
            made.Update()
        assert made.GetErrorCode() != 0, errors
        return errors[0]

    def narrow(array):
        array.SetNumberOfComponents(3)
        array.SetNumberOfTuples(48)

    assert "cell 5 has no vertex at corner 2" in message(lambda array: array.SetComponent(5, 2, -1))
    assert "cell 0 has fewer than 4 corners" in message(narrow)
    assert "has vertex 7 at" in message(lambda array: array.SetComponent(40, 0, 7))


def test_patches_of_a_curved_mesh():
    """The Klein bottle has no extraordinary points: one patch that is cut where it meets itself, at points of the mesh."""
    grid = knotwork.read(data("curved.mesh"))
    made = knotwork.vtkMeshPatches()
    made.SetInputDataObject(grid)
    made.Update()
    assert made.GetErrorCode() == 0 and made.GetOutputDataObject(0).GetNumberOfCells() == 48
    assert made.GetOutputDataObject(1).GetNumberOfPoints() == 48  # the vertices, not all of the 192 control points


def test_refusals():
    refused("medit.mesh", "MeshVersionFormatted 2\nDimension 2\nEnd\n", "line 1", "Medit")
    refused("cut.mesh", open(data("curved.mesh")).read()[:6000], "truncated")
    refused("nan.mesh", open(data("linear.mesh")).read().replace("\n0 0\n", "\n0 nan\n"), "line 22", "nan")
    refused("huge.mesh", open(data("linear.mesh")).read().replace("elements\n5", "elements\n99999999"), "line 9", "room")
    reader = knotwork.vtkMFEMReader()
    assert reader.CanReadFile(data("nurbs.mesh")) == 1 and reader.CanReadFile(path("medit.mesh")) == 0


knotwork_testing.main(globals())
