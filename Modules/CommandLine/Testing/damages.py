# SPDX-License-Identifier: BSD-3-Clause
"""Spline grids and skeletons with one fault each, as tables of name, what to do and what the message must say."""
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_BEZIER_QUADRILATERAL, VTK_QUAD, VTK_TETRA, vtkCellArray, vtkUnstructuredGrid)
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

HUGE = 1e308


def read(file):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(file)
    reader.Update()
    grid = vtkUnstructuredGrid()
    grid.DeepCopy(reader.GetOutput())
    return grid


def write(grid, file):
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(file)
    assert writer.Write() == 1
    return file


def point(grid, index, *xyz):
    grid.GetPoints().SetPoint(index, *xyz)


def fill(array, value, row):
    """Sets one row of an array."""
    values = vtk_to_numpy(array)
    values[row] = value


def table(grid, name, column, value, row=0):
    """One entry of a table of the field data."""
    values = vtk_to_numpy(grid.GetFieldData().GetArray(name))
    if values.ndim == 1:
        values[column] = value
    else:
        values[row, column] = value


def integers(name):
    """Columns of KnotworkPatches by name."""
    return ["PatchId", "Kind", "Dimension", "Rational", "Elements", "Functions", "Degree0", "Degree1", "Degree2",
            "Knots0", "Knots1", "Knots2", "Boxes", "PatchBasis", "Checksum"].index(name)


def patches(column, value):
    return lambda grid: table(grid, "KnotworkPatches", integers(column), value)


def without(name):
    return lambda grid: grid.GetFieldData().RemoveArray(name)


def keep_cells(count):
    """The first cells only, with all points and all field data."""
    def do(grid):
        cells = vtkCellArray()
        for cell in range(count):
            cells.InsertNextCell(grid.GetCell(cell).GetPointIds())
        types = [grid.GetCellType(cell) for cell in range(count)]
        data = grid.GetCellData()
        for i in range(data.GetNumberOfArrays()):
            data.GetArray(i).SetNumberOfTuples(count)
        grid.SetCells(types, cells)
    return do


def points_only(grid):
    other = vtkUnstructuredGrid()
    other.SetPoints(grid.GetPoints())
    grid.ShallowCopy(other)


def add_field(grid, name):
    values = numpy_to_vtk(np.linspace(0, 1, grid.GetNumberOfPoints()), deep=1)
    values.SetName(name)
    grid.GetPointData().AddArray(values)


def replaced(make):
    """Another grid instead."""
    def do(grid):
        grid.ShallowCopy(make())
    return do


def lone_cell(kind, points, degree=None):
    def make():
        grid = vtkUnstructuredGrid()
        coordinates = vtkPoints()
        coordinates.SetDataTypeToDouble()
        coordinates.SetData(numpy_to_vtk(np.asarray(points, float), deep=1))
        grid.SetPoints(coordinates)
        grid.InsertNextCell(kind, len(points), list(range(len(points))))
        if degree is not None:
            degrees = numpy_to_vtk(np.array([[degree, degree, 0.0]]), deep=1)
            degrees.SetName("HigherOrderDegrees")
            grid.GetCellData().SetHigherOrderDegrees(degrees)
        return grid
    return replaced(make)


def quadrilateral():
    """The unit square as one linear cell."""
    grid = vtkUnstructuredGrid()
    lone_cell(VTK_QUAD, [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])(grid)
    return grid


def square_points(count):
    return [(i % count, i // count, 0) for i in range(count * count)]


def weights(value):
    def do(grid):
        for name in ("RationalWeights", "BezierWeights"):
            fill(grid.GetPointData().GetArray(name), value, 3)
    return do


def field(value, name="Temperature"):
    return lambda grid: fill(grid.GetPointData().GetArray(name), value, 5)


def degrees(value):
    def do(grid):
        for name in ("HigherOrderDegrees", "BezierDegrees"):
            fill(grid.GetCellData().GetArray(name), value, 1)
    return do


def everywhere(value):
    def do(grid):
        vtk_to_numpy(grid.GetPoints().GetData())[:] *= value
    return do


# Of a rational annulus sector of 2 x 2 biquadratic elements, one corner refined to level 1, with the field Temperature.
REFUSED = [
    ("no_cells", points_only, []),
    ("tetrahedron", lone_cell(VTK_TETRA, [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]), ["vtkTetra"]),
    ("nan_point", lambda g: point(g, 4, np.nan, 0, 0), ["NaN"]),
    ("infinite_point", lambda g: point(g, 4, 0, np.inf, 0), []),
    ("nan_weight", weights(np.nan), ["weight"]),
    ("zero_weight", weights(0), ["weight"]),
    ("negative_weight", weights(-1), ["weight"]),
    ("infinite_weight", weights(np.inf), ["weight"]),
    ("huge_weight", weights(HUGE), ["weight"]),
    ("tiny_weight", weights(5e-324), ["weight"]),
    ("huge_point", lambda g: point(g, 4, HUGE, -HUGE, HUGE), ["point 4", "1e+60"]),
    ("huge_points", everywhere(HUGE), ["1e+60"]),
    ("nan_field", field(np.nan), ["Temperature"]),
    ("huge_field", field(HUGE), ["Temperature", "1e+60"]),
    ("missing_element", keep_cells(3), ["missing"]),
    ("degree_10", lone_cell(VTK_BEZIER_QUADRILATERAL, square_points(11), 10), ["10"]),
    ("degree_0", degrees(0), ["degree"]),
    ("degree_half", degrees(2.5), ["2.5"]),
    ("degree_nan", degrees(np.nan), ["degree"]),
    ("degree_huge", degrees(HUGE), ["degree"]),
    ("version_99", lambda g: table(g, "KnotworkSchemaVersion", 0, 99), ["99"]),
    ("version_negative", lambda g: table(g, "KnotworkSchemaVersion", 0, -1), ["-1"]),
    ("kind_7", patches("Kind", 7), ["kind", "7"]),
    ("dimension_4", patches("Dimension", 4), ["dimension", "4"]),
    ("dimension_3", patches("Dimension", 3), []),
    ("elements_2_60", patches("Elements", 2**60), ["Elements"]),
    ("functions_2_60", patches("Functions", 2**60), ["Functions"]),
    ("functions_wrong", patches("Functions", 17), []),
    ("degree0_2_60", patches("Degree0", 2**60), ["Degree0"]),
    ("degree0_10", patches("Degree0", 10), []),
    ("knots_2_60", patches("Knots0", 2**60), ["Knots0"]),
    ("knots_most", patches("Knots1", 2**31 - 1), ["Knots"]),
    ("knots_negative", patches("Knots0", -1), ["Knots0"]),
    ("knots_fewer", patches("Knots0", 3), []),
    ("boxes_2_60", patches("Boxes", 2**60), ["Boxes"]),
    ("boxes_most", patches("Boxes", 2**31 - 1), ["Boxes"]),
    ("no_knots", without("KnotworkKnots"), ["KnotworkKnots"]),
    ("knot_nan", lambda g: table(g, "KnotworkKnots", 2, np.nan), []),
    ("knot_huge", lambda g: table(g, "KnotworkKnots", 2, HUGE), []),
    ("no_boxes", without("KnotworkBoxes"), ["KnotworkBoxes"]),
    ("box_level_99", lambda g: table(g, "KnotworkBoxes", 0, 99), []),
    ("box_corner_2_60", lambda g: table(g, "KnotworkBoxes", 4, 2**60), []),
    ("box_corner_negative", lambda g: table(g, "KnotworkBoxes", 1, -2**62), []),
    ("basis_wrong", patches("Degree1", 3), []),
    ("basis_hash_wrong", patches("PatchBasis", 2**60), ["PatchBasis"]),
]

# Of a biquadratic LR height field over [0, 1]^2 with the field Heat.
REFUSED_LR = [
    ("lr_nan_point", lambda g: point(g, 4, np.nan, 0, 0), ["NaN"]),
    ("lr_huge_point", lambda g: point(g, 4, HUGE, -HUGE, HUGE), ["point 4", "1e+60"]),
    ("lr_nan_field", field(np.nan, "Heat"), ["Heat"]),
    ("lr_missing_element", keep_cells(3), ["missing"]),
    ("lr_as_thb", patches("Kind", 2), []),
    ("lr_in_space", patches("Dimension", 3), []),
    ("lr_functions_fewer", patches("Functions", 3), []),
    ("lr_degree_3", patches("Degree0", 3), []),
    ("lr_lines_2_60", patches("Boxes", 2**60), ["Boxes"]),
    ("lr_lines_fewer", patches("Boxes", 2), []),
    ("lr_no_lines", without("KnotworkMeshLines"), ["KnotworkMeshLines"]),
    ("lr_no_local_knots", without("KnotworkLocalKnots"), ["KnotworkLocalKnots"]),
    ("lr_no_scaling", without("KnotworkScaling"), ["KnotworkScaling"]),
    ("lr_no_knots", without("KnotworkKnots"), ["KnotworkKnots"]),
    ("lr_knot_nan", lambda g: table(g, "KnotworkKnots", 1, np.nan), []),
    ("lr_knot_descends", lambda g: table(g, "KnotworkKnots", 1, -1), []),
    ("lr_line_direction", lambda g: table(g, "KnotworkMeshLines", 0, 7, 1), []),
    ("lr_line_far", lambda g: table(g, "KnotworkMeshLines", 1, 2**60, 1), []),
    ("lr_line_negative", lambda g: table(g, "KnotworkMeshLines", 2, -2**62, 1), []),
    ("lr_line_multiplicity", lambda g: table(g, "KnotworkMeshLines", 3, 2**60, 1), []),
    ("lr_local_knot_far", lambda g: table(g, "KnotworkLocalKnots", 9, 2**60), []),
    ("lr_local_knot_negative", lambda g: table(g, "KnotworkLocalKnots", 9, -1), []),
    ("lr_local_knots_descend", lambda g: table(g, "KnotworkLocalKnots", 0, 3), []),
    ("lr_scaling_nan", lambda g: table(g, "KnotworkScaling", 3, np.nan), []),
    ("lr_scaling_zero", lambda g: table(g, "KnotworkScaling", 3, 0), []),
    ("lr_scaling_negative", lambda g: table(g, "KnotworkScaling", 3, -1), []),
    ("lr_scaling_twice", lambda g: table(g, "KnotworkScaling", 3, 2), []),
]

# What a spline survives: the points count, not what is kept beside them.
SURVIVED = [
    ("tiny_points", everywhere(1e-300)),
    ("no_patches", without("KnotworkPatches")),
    ("no_version", without("KnotworkSchemaVersion")),
    ("no_control_points", without("KnotworkControlPoints")),
    ("control_point_nan", lambda g: table(g, "KnotworkControlPoints", 1, np.nan, 2)),
    ("control_point_huge", lambda g: table(g, "KnotworkControlPoints", 1, HUGE, 2)),
    ("rational_7", patches("Rational", 7)),
    ("checksum_wrong", patches("Checksum", -2**63)),
    ("field_rows_2_60", lambda g: table(g, "KnotworkFieldRows", 0, 2**60)),
    ("patch_id_negative", patches("PatchId", -2**31 + 1)),
]
