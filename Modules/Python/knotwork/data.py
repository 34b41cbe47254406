# SPDX-License-Identifier: BSD-3-Clause
"""VTK's datasets with what Python people expect of them. Each class is a class of VTK: filters, writers and other packages take them."""
import os

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCharArray, vtkDoubleArray, vtkPoints
from vtkmodules.vtkCommonDataModel import (vtkCellArray, vtkDataObject, vtkImageData, vtkPartitionedDataSetCollection, vtkPolyData,
                                           vtkTable, vtkUnstructuredGrid)
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkParallelCore import vtkCommunicator

from . import vtkSplineDefinition
from .errors import make_error
from .running import run


def _array_of(values):
    """As numpy sees it, read-only where it shows memory of VTK; a list of texts for strings."""
    if hasattr(values, "GetVoidPointer") and values.GetDataType() != 13:
        view = vtk_to_numpy(values)
        view.flags.writeable = False
        return view
    return [values.GetValue(i) for i in range(values.GetNumberOfValues())]


def _arrays_of(attributes):
    return {attributes.GetArrayName(i): _array_of(attributes.GetAbstractArray(i)) for i in range(attributes.GetNumberOfArrays())}


class Patch:
    """A patch of a spline grid, as numbers.

    id: PatchId. family: "tensor-product", "hierarchical", ... degrees: one a direction, 0 where elements differ.
    knots: an array a direction; of hierarchical splines those of level 0, of LR splines the distinct ones, else empty.
    control_points: functions x 3, not multiplied by weights; first direction fastest. weights: one a function, None when polynomial."""

    def __init__(self, definition, place):
        dimension = definition.GetDimension(place)
        self.id = definition.GetPatchId(place)
        self.family = definition.GetFamily(place)
        self.degrees = tuple(definition.GetDegree(place, d) for d in range(dimension))
        self.knots = tuple(self._filled(definition.GetKnots, place, d) for d in range(dimension))
        self.control_points = self._filled(definition.GetControlPoints, place)
        weights = self._filled(definition.GetWeights, place)
        self.weights = weights if len(weights) else None

    @staticmethod
    def _filled(fill, *where):
        values = vtkDoubleArray()
        fill(*where, values)
        return _array_of(values)

    def __repr__(self):
        return f"<patch {self.id}: {self.family}, degrees {self.degrees}, {len(self.control_points)} control points>"


class Data:
    """What results have in common. The functions of the package that take data are methods, too: fit(points).contour([8]).

    outputs: all outputs of the filter that made it, by their names; empty for data of files.
    curves: what trims or bounds its surfaces, where there are such; save() writes them, too."""

    outputs = {}
    curves = None

    def save(self, file, encoding="binary"):
        """Writes a file in the format that the ending of the name says, with the curves that trim its surfaces. Returns the data.
        encoding: of numbers in VTK's formats, "ascii", "binary" or "appended". Raises knotwork.Error."""
        from .files import write

        write(self, file, self.curves, encoding)
        return self

    @property
    def numbers(self):
        """{name: value} of the filter's table of numbers (its last row: the whole, or the last iteration); empty without one."""
        tables = [each for each in self.outputs.values() if isinstance(each, vtkTable)]
        table = self.outputs.get("numbers", tables[-1] if tables else None)
        return table.row(-1) if isinstance(table, Table) and table.GetNumberOfRows() else {}

    def plot(self, **options):
        """Shows the data in a window, or writes a picture: see knotwork.plot."""
        from .plotting import plot

        return plot(self, **options)

    def __str__(self):
        return repr(self)

    def _repr_png_(self):
        """The picture that notebooks show."""
        from .plotting import picture

        return picture(self)

    def to_pyvista(self):
        """The same data as an object of PyVista. Raises ImportError without that package."""
        import pyvista

        return pyvista.wrap(self)

    def __reduce__(self):
        packed = vtkCharArray()
        if not vtkCommunicator.MarshalDataObject(self, packed):
            raise make_error(0, f"{self.GetClassName()} cannot be packed")
        return _unpack, (type(self), bytes(memoryview(packed)), {"curves": self.curves, "outputs": self.outputs})


class Splines(Data):
    """What grids and collections of grids have in common: splines are among them."""

    _decoded = (None, ())

    @property
    def spline_patches(self):
        """The patches as numbers (Patch). Raises knotwork.Error for data that are no splines."""
        time, found = self._decoded
        if time != self.GetMTime():
            definition = vtkSplineDefinition()
            if not definition.Decode(self):
                raise make_error(definition.GetErrorCode(), definition.GetErrorText())
            found = tuple(Patch(definition, i) for i in range(definition.GetNumberOfPatches()))
            self._decoded = (self.GetMTime(), found)
        return found

    def _only_patch(self):
        found = self.spline_patches
        if len(found) != 1:
            raise ValueError(f"there are {len(found)} patches; take one of spline_patches")
        return found[0]

    degrees = property(lambda self: self._only_patch().degrees, doc="Degrees of the only patch, one a direction.")
    knots = property(lambda self: self._only_patch().knots, doc="Knot vectors of the only patch, one a direction.")
    control_points = property(lambda self: self._only_patch().control_points, doc="Control points of the only patch, functions x 3.")
    weights = property(lambda self: self._only_patch().weights, doc="Weights of the only patch; None when it is polynomial.")

    def __call__(self, *parameters, patch=-1):
        """Points at parameters: s(u, v); numbers or arrays of one shape S. patch: PatchId, -1: the only one. Result: S x 3."""
        return self._evaluated("", parameters, patch, 0)

    def derivative(self, *parameters, order=None, patch=-1, field=None):
        """Partial derivatives at parameters with respect to them.
        order: one number a direction, of a sum of at most 2: (1, 0) is d/du, (1, 1) d^2/du dv; without it d/du.
        field: of this field of the splines, instead of the map. Result: S x components."""
        order = (1,) + (0,) * (len(parameters) - 1) if order is None else tuple(order)
        if len(order) != len(parameters) or min(order) < 0 or not 1 <= sum(order) <= 2:
            raise ValueError(f"order {order!r}: one number of at least 0 a parameter, with a sum of 1 or 2")
        letters = "".join(letter * times for letter, times in zip("uvw", order))
        return self._evaluated(f"{field or 'Derivative'}_{letters}", parameters, patch, sum(order))

    def field(self, name, *parameters, patch=-1):
        """A field of the splines at parameters. Result: S x components."""
        return self._evaluated(name, parameters, patch, 0)

    def _evaluated(self, name, parameters, patch, derivatives):
        from . import vtkSplineEvaluate

        wanted = {len(each.degrees) for each in self.spline_patches if patch in (-1, each.id)}
        if wanted and wanted != {len(parameters)}:
            raise TypeError(f"{len(parameters)} parameters are given; the spline has {' or '.join(map(str, sorted(wanted)))}")
        spread = np.broadcast_arrays(*(np.asarray(each, dtype=float) for each in parameters))
        rows = np.zeros((spread[0].size, 3))
        for direction, each in enumerate(spread):
            rows[:, direction] = each.ravel()
        evaluate = vtkSplineEvaluate()
        evaluate.SetInputDataObject(0, self)
        evaluate.SetInputDataObject(1, points(rows))
        evaluate.SetPatchId(patch)
        evaluate.SetDerivatives(derivatives)
        run(evaluate)
        result = evaluate.GetOutputDataObject(0)
        values = result.GetPointData().GetArray(name) if name else result.GetPoints().GetData()
        if values is None:
            raise ValueError(f"there is no field {name!r}")
        found = vtk_to_numpy(values)
        return found.reshape(spread[0].shape + found.shape[1:])


class _DataSet:
    @property
    def points(self):
        """Coordinates, points x 3, a view of VTK's memory; of splines the Bezier points."""
        return _array_of(self.GetPoints().GetData()) if self.GetPoints() else np.zeros((0, 3))

    @property
    def point_arrays(self):
        """{name: values} of the points, views of VTK's memory."""
        return _arrays_of(self.GetPointData())

    @property
    def cell_arrays(self):
        """{name: values} of the cells, views of VTK's memory."""
        return _arrays_of(self.GetCellData())

    def __repr__(self):
        return f"<knotwork {type(self).__name__}: {self.GetNumberOfCells()} cells, {self.GetNumberOfPoints()} points>"

    @property
    def invalid_cells(self):
        """Numbers of the cells that validate() proved folded, ascending; ask what it returned."""
        return self._with_verdict(lambda verdicts: verdicts < 0)

    @property
    def undecided_cells(self):
        """Numbers of the cells that validate() left undecided, ascending; ask what it returned."""
        return self._with_verdict(lambda verdicts: verdicts == 0)

    def _with_verdict(self, chosen):
        verdicts = self.GetCellData().GetArray("JacobianVerdict")
        if verdicts is None:
            raise ValueError("there are no verdicts: ask what validate() returns")
        return np.flatnonzero(chosen(vtk_to_numpy(verdicts)))


class Grid(_DataSet, Splines, vtkUnstructuredGrid):
    """A spline grid, or a mesh of cells."""


class PolyData(_DataSet, Data, vtkPolyData):
    """Triangles, polygons, lines or points."""


class Image(_DataSet, Data, vtkImageData):
    """Values on a regular grid."""


class Collection(Splines, vtkPartitionedDataSetCollection):
    """Several spline grids."""

    def __repr__(self):
        return f"<knotwork Collection: {self.GetNumberOfPartitionedDataSets()} grids>"


class Table(Data, vtkTable):
    """Rows of numbers and texts."""

    @property
    def columns(self):
        """{name: values}."""
        return _arrays_of(self.GetRowData())

    def row(self, place):
        """{name in snake_case: value} of a row; -1 is the last one."""
        from .signatures import snake_case

        rows = self.GetNumberOfRows()
        if not -rows <= place < rows:
            raise IndexError(f"row {place} of {rows}")
        found = {}
        for name, values in self.columns.items():
            value = values[place]
            found[snake_case(name)] = value.item() if hasattr(value, "item") and np.ndim(value) == 0 else value
        return found

    def __repr__(self):
        return f"<knotwork Table: {self.GetNumberOfRows()} rows, columns {', '.join(self.columns)}>"


CLASSES = {"vtkUnstructuredGrid": Grid, "vtkPolyData": PolyData, "vtkImageData": Image,
           "vtkPartitionedDataSetCollection": Collection, "vtkTable": Table}


def wrap(data):
    """Data of VTK with the methods of this package, sharing its arrays; others come back as they are."""
    made = CLASSES.get(data.GetClassName()) if data is not None else None
    if made is None or isinstance(data, Data):
        return data
    result = made()
    result.ShallowCopy(data)
    return result


def _unpack(made, packed, attributes):
    array = vtkCharArray()
    array.SetNumberOfTuples(len(packed))
    memoryview(array)[:] = memoryview(packed).cast("c")
    result = made()
    if not vtkCommunicator.UnMarshalDataObject(array, result):
        raise make_error(0, f"what was packed of a {made.__name__} is damaged")
    vars(result).update(attributes)
    return result


def points(coordinates, **arrays):
    """Scattered points: coordinates n x 3 or n x 2 (z = 0), and named arrays of n values or rows."""
    rows = np.asarray(coordinates, dtype=float)
    if rows.ndim != 2 or rows.shape[1] not in (2, 3):
        raise ValueError(f"points are rows of 2 or 3 coordinates, not an array of shape {rows.shape}")
    if rows.shape[1] == 2:
        rows = np.column_stack([rows, np.zeros(len(rows))])
    result = PolyData()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(rows), deep=True))
    result.SetPoints(places)
    for name, values in arrays.items():
        values = np.ascontiguousarray(values)
        if len(values) != len(rows):
            raise ValueError(f"{name}: {len(values)} values for {len(rows)} points")
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        result.GetPointData().AddArray(array)
    return result


def mesh(coordinates, polygons):
    """A surface mesh: coordinates n x 3, and polygons as an array of rows of point numbers (triangles, quadrilaterals)."""
    result = points(coordinates)
    rows = np.asarray(polygons)
    if rows.ndim != 2 or rows.shape[1] < 3 or not np.issubdtype(rows.dtype, np.integer):
        raise ValueError(f"polygons are rows of at least 3 point numbers, not an array of shape {rows.shape} of {rows.dtype}")
    if len(rows) and not 0 <= rows.min() <= rows.max() < result.GetNumberOfPoints():
        raise ValueError(f"polygons name points {rows.min()} to {rows.max()}; there are 0 to {result.GetNumberOfPoints() - 1}")
    cells = vtkCellArray()
    offsets = np.arange(0, rows.size + 1, rows.shape[1], dtype=np.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True),
                  numpy_to_vtkIdTypeArray(np.ascontiguousarray(rows.ravel(), dtype=np.int64), deep=True))
    result.SetPolys(cells)
    return result


def spline(knots, control_points, weights=None, degrees=None):
    """A tensor-product spline of one patch.

    knots: a knot vector a direction (curves: the knots alone).
    control_points: functions x 2 or 3, the first direction fastest, or with a leading axis a direction, last direction first
    (an array [k, j, i, :] or [j, i, :]). weights: one a control point, in the same order; None: polynomial.
    degrees: without it what the numbers of control points leave, which needs the leading axes for more than one direction, or
    clamped knots. Raises knotwork.Error."""
    vectors = [np.asarray(knots, dtype=float)] if np.ndim(knots[0]) == 0 else [np.asarray(each, dtype=float) for each in knots]
    net = np.asarray(control_points, dtype=float)
    if net.ndim not in (2, len(vectors) + 1):
        raise ValueError(f"control points of shape {net.shape} for {len(vectors)} directions: functions x 3, or an axis a direction")
    if degrees is None:
        if net.ndim == len(vectors) + 1:
            degrees = [len(each) - count - 1 for each, count in zip(vectors, net.shape[-2::-1])]
        else:
            degrees = [int(np.count_nonzero(each == each[0])) - 1 for each in vectors]
    definition = vtkSplineDefinition()
    column = lambda values: None if values is None else numpy_to_vtk(np.ascontiguousarray(np.ravel(values), dtype=float), deep=True)  # noqa: E731
    rows = numpy_to_vtk(np.ascontiguousarray(net.reshape(-1, net.shape[-1])), deep=True)
    padded = [column(each) for each in vectors] + [None] * (3 - len(vectors))
    result = Grid()
    if not (definition.AddTensorPatch(len(vectors), column(np.atleast_1d(degrees)), *padded, rows, column(weights))
            and definition.MakeGrid(result)):
        raise make_error(definition.GetErrorCode(), definition.GetErrorText())
    return result


def as_data(value):
    """Data of what a function is given: data, an algorithm, a file's name, an array of points, or a list of such, which become one
    collection (arrays in it: polylines)."""
    if isinstance(value, vtkDataObject):
        return value
    if isinstance(value, vtkAlgorithm):
        run(value)
        return value.GetOutputDataObject(0)
    if isinstance(value, (str, os.PathLike)):
        from .files import read

        return read(value)
    if isinstance(value, (list, tuple)) and value and not np.isscalar(value[0]) and (
            isinstance(value[0], (vtkDataObject, str, os.PathLike)) or np.ndim(value[0]) == 2):
        result = Collection()
        for place, each in enumerate(value):
            result.SetPartition(place, 0, each if isinstance(each, vtkDataObject) else
                                as_data(each) if isinstance(each, (str, os.PathLike)) else polyline(each))
        return result
    try:
        return points(value)
    except (TypeError, ValueError) as fault:
        raise TypeError(f"{type(value).__name__} is neither data, a file's name, nor an array of points: {fault}") from None


def polyline(coordinates):
    """A spline curve of degree 1 through points, n x 2 or 3, by the length of its chords over [0, 1]."""
    rows = np.asarray(coordinates, dtype=float)
    lengths = np.linalg.norm(np.diff(rows, axis=0), axis=1)
    if len(rows) < 2 or not np.all(lengths > 0):
        raise ValueError("a polyline has at least two points, and no two that follow each other are one")
    at = np.concatenate([[0.0], np.cumsum(lengths) / lengths.sum()])
    at[-1] = 1.0
    return spline(np.concatenate([[0.0], at, [1.0]]), rows, degrees=[1])
