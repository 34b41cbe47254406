# SPDX-License-Identifier: BSD-3-Clause
"""Tessellation from Python: the tolerance, exact fields and normals, arrays that lead back, solids, limits, errors."""
import knotwork
import knotwork_testing
import numpy
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import (vtkPartitionedDataSet, vtkPartitionedDataSetCollection, vtkPolyData, vtkTable,
                                           vtkUnstructuredGrid)
from vtkmodules.vtkFiltersCore import vtkFeatureEdges

EPS = numpy.finfo(float).eps


def source(name, **properties):
    made = knotwork.vtkSplineSource()
    made.SetShapeName(name)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    return made


def tessellate(algorithm, **properties):
    made = knotwork.vtkSplineTessellate()
    made.SetInputConnection(algorithm.GetOutputPort())
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    made.Update()
    return made


def polygons(mesh):
    """Corner numbers of all polygons."""
    cells = mesh.GetPolys()
    offsets = dataset_adapter.vtkDataArrayToVTKArray(cells.GetOffsetsArray())
    connectivity = dataset_adapter.vtkDataArrayToVTKArray(cells.GetConnectivityArray())
    return [connectivity[a:b] for a, b in zip(offsets[:-1], offsets[1:])]


def test_defaults():
    made = knotwork.vtkSplineTessellate()
    assert (made.GetChordalTolerance(), made.GetRelativeTolerance(), made.GetMaximumSubdivision()) == (1e-3, True, 8)
    assert (made.GetCells(), made.GetNormals(), made.GetSplitting(), made.GetThreads()) == (made.SURFACE, True, False, 0)
    made.SetMaximumSubdivision(10)
    assert made.GetMaximumSubdivision() == 10


def test_sphere_stays_within_the_tolerance():
    for tolerance in (1e-1, 1e-2, 1e-3):
        made = tessellate(source("SphereSurface"), ChordalTolerance=tolerance, RelativeTolerance=False)
        mesh = made.GetOutputDataObject(0)
        assert isinstance(mesh, vtkPolyData)
        data = dataset_adapter.WrapDataObject(mesh)
        radii = numpy.linalg.norm(data.Points, axis=1)
        assert abs(radii - 1).max() <= 64 * EPS  # rounding of one evaluation
        assert abs(data.PointData["Normals"] - data.Points).max() <= 1e-12
        middles = numpy.array([data.Points[corners].mean(axis=0) for corners in polygons(mesh)])
        deepest = 1 - numpy.linalg.norm(middles, axis=1).min()
        bound = data.FieldData["ChordalBound"][0]
        assert tolerance / 60 < deepest <= bound <= tolerance, (deepest, bound, tolerance)
        edges = vtkFeatureEdges()
        edges.SetInputData(mesh)
        edges.FeatureEdgesOff()
        edges.Update()
        assert edges.GetOutput().GetNumberOfCells() == 0


def test_fields_are_exact_and_arrays_lead_back():
    disc = source("Disc", Elements=(2, 2, 1))
    disc.Update()
    grid = disc.GetOutputDataObject(0)
    points = numpy.array(dataset_adapter.WrapDataObject(grid).Points)
    height = numpy_to_vtk(points @ [3.0, -2.0, 0.0], deep=1)
    height.SetName("Height")
    grid.GetPointData().AddArray(height)
    made = knotwork.vtkSplineTessellate()
    made.SetInputDataObject(grid)
    made.Update()
    mesh = dataset_adapter.WrapDataObject(made.GetOutputDataObject(0))
    assert abs(mesh.PointData["Height"] - mesh.Points @ numpy.array([3.0, -2.0, 0.0])).max() <= 1e-13
    assert set(mesh.CellData["PatchId"]) == {0, 1, 2, 3, 4}
    local = mesh.PointData["LocalParameters"]
    assert local.min() == 0 and local.max() == 1
    # the elements of the cells are elements of the patches
    for patch in range(5):
        elements = mesh.CellData["ElementId"][mesh.CellData["PatchId"] == patch]
        assert set(elements) == {0, 1, 2, 3}


def test_solids():
    surface = tessellate(source("Cube"))
    assert surface.GetOutputDataObject(0).GetNumberOfPolys() == 6
    surface.SetCells(surface.VOLUME)
    surface.Update()
    volume = surface.GetOutputDataObject(0)
    assert isinstance(volume, vtkUnstructuredGrid)
    assert volume.GetNumberOfCells() == 1 and volume.GetCell(0).GetClassName() == "vtkHexahedron"


def test_collections():
    collection = vtkPartitionedDataSetCollection()
    for block, name in enumerate(("Arc", "Square")):
        made = source(name)
        made.Update()
        part = vtkPartitionedDataSet()
        part.SetPartition(0, made.GetOutputDataObject(0))
        collection.SetPartitionedDataSet(block, part)
    filter_ = knotwork.vtkSplineTessellate()
    filter_.SetInputDataObject(collection)
    filter_.Update()
    output = filter_.GetOutputDataObject(0)
    assert output.GetPartition(0, 0).GetNumberOfLines() > 4
    assert output.GetPartition(1, 0).GetNumberOfPolys() == 1


def test_splitting_keeps_creases_sharp():
    smooth = tessellate(source("Cube")).GetOutputDataObject(0)
    sharp = tessellate(source("Cube"), Splitting=True).GetOutputDataObject(0)
    assert (smooth.GetNumberOfPoints(), sharp.GetNumberOfPoints()) == (8, 24)
    normals = abs(numpy.array(dataset_adapter.WrapDataObject(sharp).PointData["Normals"]))
    assert (numpy.sort(normals, axis=1) == [0, 0, 1]).all()


def test_limits_and_errors():
    warnings = []

    def record(caller, event, text=""):
        warnings.append(text)

    record.CallDataType = "string0"
    sphere = source("SphereSurface")
    coarse = knotwork.vtkSplineTessellate()
    coarse.SetInputConnection(sphere.GetOutputPort())
    coarse.SetMaximumSubdivision(1)
    coarse.AddObserver("WarningEvent", record)
    coarse.Update()
    assert len(warnings) == 1 and "raise MaximumSubdivision" in warnings[0]

    torus = source("TorusSurface", Elements=(30, 30, 1))
    huge = knotwork.vtkSplineTessellate()
    huge.SetInputConnection(torus.GetOutputPort())
    huge.SetChordalTolerance(1e-12)
    huge.SetMaximumSubdivision(10)
    with knotwork_testing.Errors(huge) as errors:
        huge.Update()
    assert huge.GetErrorCode() == 40013 and len(errors) >= 1
    assert huge.GetOutputDataObject(0).GetNumberOfCells() == 0

    wrong = knotwork.vtkSplineTessellate()
    wrong.SetInputDataObject(vtkTable())
    with knotwork_testing.Errors(wrong) as errors:
        wrong.Update()
    assert errors


knotwork_testing.main(globals())
