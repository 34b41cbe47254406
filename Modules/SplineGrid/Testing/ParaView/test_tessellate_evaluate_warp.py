# SPDX-License-Identifier: BSD-3-Clause
"""Tessellation, evaluation and warp through ParaView's proxies, between ParaView's own sources and filters."""
import re

import knotwork_testing

knotwork_testing.load_plugin()
from paraview import servermanager  # noqa: E402
from paraview.simple import (  # noqa: E402
    Calculator, Clip, ColorBy, Contour, CreateRenderView, GetColorTransferFunction, GroupDatasets, IntegrateVariables,
    KnotworkSplineSource, Plane, Show, Slice, Sphere, SplineEvaluate, SplineRefine, SplineTessellate, SplineWarp, Transform)
from vtkmodules.numpy_interface import dataset_adapter  # noqa: E402

import numpy  # noqa: E402


def fetch(proxy):
    """The output on the client, wrapped; ParaView's selection of blocks is not in the way."""
    return dataset_adapter.WrapDataObject(servermanager.Fetch(proxy))


def total(proxy, name):
    """ParaView's integral of Area, Length or Volume over linear cells."""
    return fetch(IntegrateVariables(Input=proxy)).CellData[name][0]


def test_every_property_reaches_the_filter():
    # values other than the defaults, read from what the filters print
    square = KnotworkSplineSource()
    tessellate = SplineTessellate(Input=square, ChordalTolerance=0.25, RelativeTolerance=0, MaximumSubdivision=3,
                                  Cells="Volume", Normals=0, Splitting=1, Threads=1)
    evaluate = SplineEvaluate(Input=square, Points=Plane(), Mode="Probe", Derivatives=2, ParameterArray="UV",
                              PatchIdArray="Side", PatchId=4, Threads=1)
    warp = SplineWarp(Input=square, Map=square, MapPatchId=2, Clamp=1, Tolerance=0.5, MaxLevel=2, Threads=1)
    for proxy, expected in (
            (tessellate, {"ChordalTolerance": "0.25", "RelativeTolerance": "0", "MaximumSubdivision": "3", "Cells": "1",
                          "Normals": "0", "Splitting": "1", "Threads": "1"}),
            (evaluate, {"Mode": "1", "Derivatives": "2", "ParameterArray": "UV", "PatchIdArray": "Side", "PatchId": "4",
                        "Threads": "1"}),
            (warp, {"MapPatchId": "2", "Clamp": "1", "Tolerance": "0.5", "MaxLevel": "2", "Threads": "1"})):
        proxy.SMProxy.UpdateVTKObjects()
        printed = dict(re.findall(r"^ *(\w+): (.*)$", str(proxy.GetClientSideObject()), re.M))
        for name, value in expected.items():
            assert printed[name] == value, (name, printed[name], value)


def test_tessellation_is_what_paraview_measures():
    sphere = SplineTessellate(Input=KnotworkSplineSource(Shape="Sphere Surface"), ChordalTolerance=1e-4)
    assert abs(total(sphere, "Area") / (4 * numpy.pi) - 1) < 1e-3
    refined = SplineRefine(Input=KnotworkSplineSource(Shape="Solid Tube", Elements=[2, 3, 2]), Mode="Cell Array",
                           Array=["CELLS", "ElementId"], LowerThreshold=0, UpperThreshold=0, NumberOfRefinements=2)
    solid = SplineTessellate(Input=refined, ChordalTolerance=1e-4, Cells="Volume")
    # a quarter of the tube between the radii 1/2 and 1, of height 1
    assert abs(total(solid, "Volume") / (numpy.pi / 4 * 0.75) - 1) < 1e-3
    moved = Transform(Input=refined)
    moved.Transform.Scale = [2, 1, 1]
    moved.Transform.Rotate = [30, 0, 40]
    bigger = SplineTessellate(Input=moved, ChordalTolerance=1e-4, Cells="Volume")
    assert abs(total(bigger, "Volume") / total(solid, "Volume") - 2) < 1e-5


def test_paraview_filters_take_the_tessellation():
    ball = SplineTessellate(Input=KnotworkSplineSource(Shape="Ball"), ChordalTolerance=1e-3, Cells="Volume")
    disc = Slice(Input=ball)
    disc.SliceType.Origin = [0, 0, 0]
    disc.SliceType.Normal = [0, 0, 1]
    assert abs(total(disc, "Area") / numpy.pi - 1) < 0.01
    half = Clip(Input=ball)
    half.ClipType.Origin = [0, 0, 0]
    half.ClipType.Normal = [1, 0, 0]
    assert abs(total(half, "Volume") / (2 * numpy.pi / 3) - 1) < 0.01
    radius = Calculator(Input=ball, ResultArrayName="Radius", Function="mag(coords)")
    shell = Contour(Input=radius, ContourBy=["POINTS", "Radius"], Isosurfaces=[0.7])
    assert abs(total(shell, "Area") / (4 * numpy.pi * 0.49) - 1) < 0.05  # linear between points


def test_fields_of_paraviews_calculator_are_evaluated():
    # a field made by ParaView from the Bezier points is a field of the spline
    annulus = Calculator(Input=KnotworkSplineSource(Shape="Annulus Sector", Elements=[2, 2, 1]), ResultArrayName="Height",
                         Function="coordsX + 3*coordsY")
    mesh = fetch(SplineTessellate(Input=annulus))
    assert abs(mesh.PointData["Height"] - mesh.Points @ numpy.array([1.0, 3.0, 0.0])).max() < 1e-13
    parameters = Plane(Origin=[0, 0, 0], Point1=[1, 0, 0], Point2=[0, 1, 0], XResolution=7, YResolution=5)
    found = fetch(SplineEvaluate(Input=annulus, Points=parameters, Derivatives=2))
    u = fetch(parameters).Points[:, 0]
    assert abs(numpy.linalg.norm(found.Points, axis=1) - (0.5 + 0.5 * u)).max() < 1e-6  # the plane's points are float
    slope = found.PointData["Derivative_u"] @ numpy.array([1.0, 3.0, 0.0])
    assert abs(found.PointData["Height_u"] - slope).max() < 1e-12
    assert "Height_uv" in found.PointData.keys() and "Derivative_vv" in found.PointData.keys()


def test_probe():
    cloud = Sphere(Radius=2.0, ThetaResolution=16, PhiResolution=16)
    found = fetch(SplineEvaluate(Input=KnotworkSplineSource(Shape="Sphere Surface"), Points=cloud, Mode="Probe"))
    assert abs(found.PointData["Distance"] - 1).max() < 1e-6  # the cloud's points are float
    assert set(found.PointData["PatchId"]) == set(range(6))


def test_warp_of_points_and_of_splines():
    ring = KnotworkSplineSource(Shape="Annulus Sector")
    plane = Plane(Origin=[0, 0, 0], Point1=[1, 0, 0], Point2=[0, 1, 0], XResolution=200, YResolution=200)
    exact = numpy.pi / 4 * 0.75
    assert abs(total(SplineWarp(Input=plane, Map=ring), "Area") / exact - 1) < 1e-3
    square = KnotworkSplineSource(Shape="Square", Center=[0.5, 0.5, 0], Degree=3)
    image = SplineWarp(Input=square, Map=ring, Tolerance=1e-5)
    assert fetch(image).CellData["Distance"].max() <= 1e-5
    assert abs(total(SplineTessellate(Input=image, ChordalTolerance=1e-5), "Area") / exact - 1) < 1e-3
    # the image is a spline like any other
    assert fetch(SplineRefine(Input=image)).GetNumberOfCells() == 4 * fetch(image).GetNumberOfCells()


def test_groups():
    group = GroupDatasets(Input=[KnotworkSplineSource(Shape="Disc", Center=[0.5, 0.5, 0], OuterRadius=0.4, InnerRadius=0.2),
                                 KnotworkSplineSource(Shape="Arc", OuterRadius=0.9)],
                          OutputType="vtkPartitionedDataSetCollection")
    image = SplineWarp(Input=group, Map=KnotworkSplineSource(Shape="Annulus Sector"))
    mesh = SplineTessellate(Input=image)
    for proxy in (image, mesh):
        proxy.UpdatePipeline()
        output = proxy.GetClientSideObject().GetOutputDataObject(0)
        assert output.IsA("vtkPartitionedDataSetCollection")
        assert all(output.GetPartition(block, 0).GetNumberOfCells() > 0 for block in range(2))


def test_picture():
    """The main chain: a disc through the map of an annulus, tessellated, coloured by patch."""
    disc = KnotworkSplineSource(Shape="Disc", Center=[0.5, 0.5, 0], OuterRadius=0.45, InnerRadius=0.2, Degree=3)
    image = SplineWarp(Input=disc, Map=KnotworkSplineSource(Shape="Annulus Sector"))
    mesh = SplineTessellate(Input=image, ChordalTolerance=3e-3)
    view = CreateRenderView()
    view.InteractionMode = "2D"
    view.CameraPosition = [0.52, 0.52, 3]
    view.CameraFocalPoint = [0.52, 0.52, 0]
    view.CameraViewUp = [0, 1, 0]
    view.CameraParallelProjection = 1
    view.CameraParallelScale = 0.5
    shown = Show(mesh, view)
    shown.Representation = "Surface With Edges"
    shown.EdgeColor = [0.1, 0.1, 0.2]
    shown.Ambient, shown.Diffuse = 1.0, 0.0
    ColorBy(shown, ("CELLS", "PatchId"))
    colours = GetColorTransferFunction("PatchId")
    colours.InterpretValuesAsCategories = 1
    colours.Annotations = [text for patch in "01234" for text in (patch, patch)]
    colours.IndexedColors = [0.34, 0.71, 0.91, 0.90, 0.62, 0.0, 0.0, 0.62, 0.45, 0.95, 0.90, 0.25, 0.80, 0.47, 0.65]
    shown.SetScalarBarVisibility(view, False)
    knotwork_testing.save_and_compare(view, "ParaViewSplineWarp")


knotwork_testing.main(globals())
