# SPDX-License-Identifier: BSD-3-Clause
"""A boundary file through Domain Parameterization and the validator in ParaView: numbers, and the map as a picture."""
import json
import math
import os
import shutil

import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import (  # noqa: E402
    ColorBy, CreateRenderView, Delete, DomainBoundaryReader, DomainParameterization, GetColorTransferFunction,
    JacobianValidator, OutputPort, Plane, Show)

COUNT = 12  # control points a side


def side(start, end, height):
    """A cubic from start to end whose control polygon swings one and a half times by height."""
    along = (end[0] - start[0], end[1] - start[1])
    points = []
    for i in range(COUNT):
        t = i / (COUNT - 1)
        swing = height * math.sin(3 * math.pi * t) * (4 * t * (1 - t)) ** 1.5
        points.append([start[0] + t * along[0] - swing * along[1], start[1] + t * along[1] + swing * along[0]])
    inner = [i / (COUNT - 3) for i in range(1, COUNT - 3)]
    return {"degree": 3, "knots": [0] * 4 + inner + [1] * 4, "control_points": points}


def boundary_file(height):
    """A unit square whose sides wave."""
    sides = [side((0, 0), (1, 0), height), side((0, 1), (1, 1), height), side((0, 0), (0, 1), -height),
             side((1, 0), (1, 1), -height)]
    name = knotwork_testing.output(f"ParaViewWaves{height}.json")
    with open(name, "w") as stream:
        json.dump({"curves": sides}, stream)
    return name


def parameterized(height=0.32, **properties):
    return DomainParameterization(Input=DomainBoundaryReader(FileName=boundary_file(height)), **properties)


def draw(domain, port=0):
    """The elements of a map in alternating colours."""
    view = CreateRenderView()
    view.CameraPosition, view.CameraFocalPoint = [0.5, 0.5, 3], [0.5, 0.5, 0]
    view.CameraParallelProjection, view.CameraParallelScale = 1, 0.8
    surface = Show(OutputPort(domain, port), view)
    surface.NonlinearSubdivisionLevel = 4
    ColorBy(surface, ("CELLS", "ElementId"))
    table = GetColorTransferFunction("ElementId")
    table.AutomaticRescaleRangeMode = "Never"
    table.Discretize = 0
    table.RGBPoints = [value for element in range((COUNT - 3)**2) for value in
                       (element, *((0.3, 0.75, 1) if element % 2 else (1, 0.9, 0.3)))]
    surface.SetScalarBarVisibility(view, False)
    surface.Ambient, surface.Diffuse = 1, 0  # flat colours
    return view


def summary(validator, column):
    """The last row of the validator's table, for all cells."""
    table = validator.GetClientSideObject().GetOutputDataObject(2)
    return table.GetValueByName(table.GetNumberOfRows() - 1, column)


def fails(comparison, *arguments):
    try:
        comparison(*arguments)
    except AssertionError:
        return True
    return False


def test_numbers_and_picture():
    domain = parameterized()
    validator = JacobianValidator(Input=OutputPort(domain, 0))
    validator.UpdatePipeline()
    field = domain.GetClientSideObject().GetOutputDataObject(0).GetFieldData()
    assert field.GetAbstractArray("Verdict").GetValue(0) == "valid"
    assert summary(validator, "Verdict").ToString() == "valid"
    assert summary(validator, "Injective").ToString() == "injective"
    assert field.GetArray("JacobianMinLower").GetTuple1(0) > 0
    assert field.GetArray("MinDetOverArea").GetTuple1(0) > 0
    assert abs(summary(validator, "Measure").ToDouble() - field.GetArray("Area").GetTuple1(0)) < 1e-12
    history = domain.GetClientSideObject().GetOutputDataObject(2)
    assert history.GetNumberOfRows() > 2
    view = draw(domain)
    knotwork_testing.save_and_compare(view, "ParaViewDomainParameterization")
    Delete(view)


def test_first_map_folds():
    domain = parameterized(InitialMap="Coons")
    validator = JacobianValidator(Input=OutputPort(domain, 1))
    validator.UpdatePipeline()
    assert summary(validator, "Verdict").ToString() == "invalid"


def test_layout_is_a_mesh_of_any_source():
    corners = [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)]
    sides = [side(corners[k], corners[(k + 1) % 6], 0.1) for k in range(6)]
    name = knotwork_testing.output("ParaViewTwoPatches.json")
    with open(name, "w") as stream:
        json.dump({"curves": sides}, stream)
    plane = Plane(Origin=[0, 0, 0], Point1=[2, 0, 0], Point2=[0, 1, 0], XResolution=2, YResolution=1)
    domain = DomainParameterization(Input=DomainBoundaryReader(FileName=name), Layout=plane)
    domain.MinimumElements = 2
    validator = JacobianValidator(Input=OutputPort(domain, 0))
    validator.UpdatePipeline()
    field = domain.GetClientSideObject().GetOutputDataObject(0).GetFieldData()
    assert field.GetAbstractArray("Verdict").GetValue(0) == "valid"
    assert field.GetAbstractArray("Injective").GetValue(0) == "injective"
    assert field.GetArray("Patches").GetTuple1(0) == 2
    assert summary(validator, "Injective").ToString() == "injective"
    assert abs(summary(validator, "Measure").ToDouble() - field.GetArray("Area").GetTuple1(0)) < 1e-12


def test_wrong_pictures_are_noticed():
    baseline = knotwork_testing.BASELINE_DIR
    expected = os.path.join(baseline, "ParaViewDomainParameterization.png")
    knotwork_testing.BASELINE_DIR = os.path.dirname(knotwork_testing.output("ParaViewWrong/x"))
    try:
        shutil.copy(expected, os.path.join(knotwork_testing.BASELINE_DIR, "ParaViewDomainWrong.png"))
        for height, port in ((0.3, 0), (0.32, 1)):  # waves slightly less high; the first map
            view = draw(parameterized(height, InitialMap="Coons"), port)
            assert fails(knotwork_testing.save_and_compare, view, "ParaViewDomainWrong"), (height, port)
            Delete(view)
    finally:
        knotwork_testing.BASELINE_DIR = baseline


knotwork_testing.main(globals())
