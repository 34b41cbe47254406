# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of Gmsh and Abaqus from Python and from the command line: cells, groups, sets, numbers, round trips, folded elements by their numbers, what
is refused."""
import json
import os

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (VTK_BEZIER_CURVE, VTK_BEZIER_QUADRILATERAL, VTK_BEZIER_TETRAHEDRON, VTK_BEZIER_TRIANGLE, VTK_HEXAHEDRON,
                                           VTK_LAGRANGE_CURVE, VTK_LINE, VTK_QUADRATIC_HEXAHEDRON, VTK_QUADRATIC_TETRA, VTK_QUADRATIC_WEDGE,
                                           VTK_TETRA, VTK_TRIANGLE, vtkUnstructuredGrid)

def path(name):
    return knotwork_testing.output("solver_meshes/" + name)


def written(name, text):
    with open(path(name), "w") as stream:
        stream.write(text)
    return path(name)


def validated(file):
    done = knotwork_testing.run_program("validate", file, "--report", path("report.json"))
    assert done.returncode in (0, 3, 4), (file, done.stderr)
    with open(path("report.json")) as stream:
        return json.load(stream), done.stdout


def array(grid, name):
    return vtk_to_numpy(grid.GetCellData().GetArray(name))


# a unit tetrahedron and one that is turned inside out, a triangle of a group and a line
TETRAHEDRA = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 4 "the side"
3 7 "the part"
$EndPhysicalNames
$Nodes
5
10 0 0 0
20 1 0 0
30 0 1 0
1000000000 0 0 1
40 1 1 1
$EndNodes
$Elements
4
501 1 2 0 1 10 20
502 2 2 4 2 10 20 30
503 4 2 7 3 10 20 30 1000000000
504 4 2 7 3 20 30 40 1000000000
$EndElements
"""


def test_cells_groups_and_numbers():
    grid = knotwork.read(written("two.msh", TETRAHEDRA))
    assert [grid.GetCellType(c) for c in range(4)] == [VTK_LINE, VTK_TRIANGLE, VTK_TETRA, VTK_TETRA]
    assert list(array(grid, "PhysicalGroup")) == [0, 4, 7, 7] and list(array(grid, "ElementNumber")) == [501, 502, 503, 504]
    assert list(array(grid, "GeometricEntity")) == [1, 2, 3, 3]
    assert list(vtk_to_numpy(grid.GetPointData().GetArray("NodeNumber"))) == [10, 20, 30, 1000000000, 40]
    names = grid.GetFieldData().GetAbstractArray("PhysicalGroupNames")
    assert [names.GetValue(i) for i in range(2)] == ["the side", "the part"]
    assert vtk_to_numpy(grid.GetFieldData().GetArray("PhysicalGroupIds")).tolist() == [[2, 4], [3, 7]]


def test_what_is_written_is_read_again():
    grid = knotwork.read(written("two.msh", TETRAHEDRA))
    grid.GetCellData().GetArray("ElementNumber").SetValue(3, 2**61 + 1)
    for encoding in ("ascii", "binary"):
        knotwork.write(grid, path("again.msh"), encoding=encoding)
        again = knotwork.read(path("again.msh"))
        for name in ("PhysicalGroup", "ElementNumber", "GeometricEntity"):
            assert np.array_equal(array(grid, name), array(again, name)), name
        assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), vtk_to_numpy(again.GetPoints().GetData()))
        assert np.array_equal(vtk_to_numpy(grid.GetCells().GetConnectivityArray()), vtk_to_numpy(again.GetCells().GetConnectivityArray()))


def test_the_folded_element_is_named_as_the_file_numbers_it():
    # the middle of the edge from node 1 to node 2 lies behind node 2
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1.4, 0, 0), (.5, .5, 0), (0, .5, 0), (0, 0, .5), (0, .5, .5), (.5, 0, .5)]
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n" + "".join("%d %g %g %g\n" % (i + 1, *p) for i, p in enumerate(points)) + \
        "$EndNodes\n$Elements\n1\n4711 11 2 0 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n"
    report, printed = validated(written("folded.msh", text))
    assert report["verdict"] == "invalid" and report["folded_elements"] == [4711] and report["witness_element"] == 4711, report
    assert "element 4711 is folded" in printed, printed


def test_abaqus():
    tetrahedron = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (.5, 0, 0), (.5, .5, 0), (0, .5, 0), (0, 0, .5), (.5, 0, .5), (0, .5, .5)]
    cube = [(2 + x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    cube += [tuple(np.add(cube[a], cube[b]) / 2) for a, b in
             ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))]
    wedge = [(4 + x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (0, 1))]
    wedge += [tuple(np.add(wedge[a], wedge[b]) / 2) for a, b in ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5))]
    points = tetrahedron + cube + wedge
    text = "*NODE\n" + "".join("%d, %.17g, %.17g, %.17g\n" % (i + 1, *p) for i, p in enumerate(points))
    begin = 1
    for number, (kind, count) in enumerate((("C3D10M", 10), ("C3D20R", 20), ("C3D15", 15))):
        nodes = [str(n) for n in range(begin, begin + count)]
        text += "*ELEMENT, TYPE=%s, ELSET=set%d\n%d, %s,\n%s\n" % (kind, number, 100 + number, ", ".join(nodes[:7]), ", ".join(nodes[7:]))
        begin += count
    file = written("three.inp", text + "*NSET, NSET=fixed, GENERATE\n1, 4, 1\n")
    grid = knotwork.read(file)
    assert [grid.GetCellType(c) for c in range(3)] == [VTK_QUADRATIC_TETRA, VTK_QUADRATIC_HEXAHEDRON, VTK_QUADRATIC_WEDGE]
    assert list(array(grid, "set1")) == [0, 1, 0] and list(array(grid, "PhysicalGroup")) == [1, 2, 3]
    assert vtk_to_numpy(grid.GetPointData().GetArray("fixed")).sum() == 4
    report, _ = validated(file)
    # each right-handed and of straight edges: volumes 1/6, 1, 1/2
    assert report["verdict"] == "valid" and abs(report["measure"] - (1 / 6 + 1 + 1 / 2)) < 1e-12, report
    knotwork.write(grid, path("three.msh"))
    assert abs(validated(path("three.msh"))[0]["measure"] - 5 / 3) < 1e-12


def bezier_cells():
    """Polynomial Bezier cells with moved points: hexahedra of a spline, and one of each other shape."""
    source = knotwork.vtkSplineSource()
    source.SetShapeName("Cube")
    source.SetDegree(3)
    source.SetElements(2, 1, 2)
    source.Update()
    cells = [source.GetOutput()]
    for kind, degree, count in ((VTK_BEZIER_TRIANGLE, 3, 10), (VTK_BEZIER_QUADRILATERAL, 4, 25), (VTK_BEZIER_TETRAHEDRON, 2, 10), (VTK_BEZIER_CURVE, 5, 6)):
        grid = vtkUnstructuredGrid()
        lagrange = vtkUnstructuredGrid()
        for one in (grid, lagrange):
            points = vtkPoints()
            points.SetDataTypeToDouble()
            points.SetNumberOfPoints(count)
            one.SetPoints(points)
        lagrange.InsertNextCell(kind - VTK_BEZIER_CURVE + VTK_LAGRANGE_CURVE, count, list(range(count)))
        places = lagrange.GetCell(0).GetParametricCoords()
        for i in range(count):
            grid.GetPoints().SetPoint(i, *places[3 * i:3 * i + 3])
        grid.InsertNextCell(kind, count, list(range(count)))
        cells.append(grid)
    random = np.random.default_rng(3)
    for grid in cells:
        points = vtk_to_numpy(grid.GetPoints().GetData())
        points += 0.03 * random.uniform(-1, 1, points.shape)
    return cells


def test_bezier_cells_become_nodes_of_the_same_polynomials():
    for grid in bezier_cells():
        file = path("bezier.msh")
        knotwork.write(grid, file)
        again = knotwork.read(file)
        assert again.GetNumberOfPoints() == grid.GetNumberOfPoints() and again.GetNumberOfCells() == grid.GetNumberOfCells()
        found = []
        for one in (grid, again):
            validator = knotwork.vtkJacobianValidator()
            validator.SetInputData(one)
            validator.SetRelativeGap(1e-6)
            validator.Update()
            found.append([array(validator.GetOutput(), name) for name in ("CellMeasure", "JacobianMinLower", "JacobianMinUpper")])
        # rounding of the nodes, and the gap of the bounds
        assert np.allclose(found[0][0], found[1][0], rtol=1e-12, atol=1e-14), found
        assert np.allclose(found[0][1:], found[1][1:], rtol=3e-6), found
    tube = knotwork.vtkSplineSource()
    tube.SetShapeName("SolidTube")
    tube.SetDegree(2)
    tube.Update()
    for cells, words in ((tube.GetOutput(), "cell 0 is rational"), (uneven_cell(), "no degree"), (curves_of_one_point(), "share point 2")):
        try:
            knotwork.write(cells, path("bezier.msh"))
        except knotwork.errors.Error as error:
            assert words in str(error), error
            continue
        raise AssertionError(words)


def curves_of_one_point():
    """Two parabolas with the coefficient in the middle in common, and nothing else."""
    grid = vtkUnstructuredGrid()
    points = vtkPoints()
    for x, y in ((0, 0), (2, 0), (1, 1), (0, 4), (2, 5)):
        points.InsertNextPoint(x, y, 0)
    grid.SetPoints(points)
    for ends in ((0, 1), (3, 4)):
        grid.InsertNextCell(VTK_BEZIER_CURVE, 3, [*ends, 2])
    return grid


def uneven_cell():
    """Of degrees 2 and 1."""
    grid = vtkUnstructuredGrid()
    points = vtkPoints()
    for x, y in ((0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1)):
        points.InsertNextPoint(x, y, 0)
    grid.SetPoints(points)
    grid.InsertNextCell(VTK_BEZIER_QUADRILATERAL, 6, list(range(6)))
    degrees = numpy_to_vtk(np.array([[2.0, 1.0, 0.0]]), deep=True)
    degrees.SetName("HigherOrderDegrees")
    grid.GetCellData().SetHigherOrderDegrees(degrees)
    return grid


def test_refused():
    for name, text, word in (("cut.msh", TETRAHEDRA[:200], "truncated"), ("v1.msh", TETRAHEDRA.replace("2.2", "1.0"), "'1.0'"),
                             ("node.msh", TETRAHEDRA.replace("10 20 30 1000000000", "10 20 30 99"), "element 503 has node 99"),
                             ("include.inp", "*INCLUDE, INPUT=a.inp\n", "put its lines")):
        try:
            knotwork.read(written(name, text))
        except ValueError as failure:
            assert name in str(failure) and word in str(failure), str(failure)
            continue
        raise AssertionError(name)


os.makedirs(path(""), exist_ok=True)
knotwork_testing.main(globals())
