# SPDX-License-Identifier: BSD-3-Clause
"""The gallery's examples of fits, by the program from files to files, measured against the formulas of their shapes."""
import json
import os
import sys

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkFeatureEdges

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "..", "Examples", "Gallery"))
import _fit_examples as examples  # noqa: E402

FOLDER = os.path.dirname(knotwork_testing.output("cad_fit_examples/files"))


def fit(name, part, mesh, *words, timeout=120):
    """The spline and the report."""
    mesh_file, part_file = examples.write(FOLDER, name, part, mesh)
    done = knotwork_testing.run_program("cadfit", mesh_file, "--target", part_file, "--output", name + ".vtu", "--report",
                                        name + ".json", *words, folder=FOLDER, timeout=timeout)
    assert done.returncode == 0, (name, done.stderr)
    with open(os.path.join(FOLDER, name + ".json"), encoding="utf-8") as file:
        return knotwork.read(os.path.join(FOLDER, name + ".vtu")), json.load(file)


def drawn(spline, tolerance):
    """Facets or lines whose points are on the spline."""
    made = knotwork.vtkSplineTessellate()
    made.SetInputDataObject(spline)
    made.SetChordalTolerance(tolerance)
    made.Update()
    return made.GetOutputDataObject(0)


def boundary(spline):
    made = knotwork.vtkSplineExtract()
    made.SetInputDataObject(spline)
    made.BoundaryOn()
    made.Update()
    return made.GetOutputDataObject(0)


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def test_part_is_what_its_formulas_say():
    """The control points themselves, by Bernstein polynomials: arcs are on their circles, the cap on its sphere."""
    def bernstein(t):
        return np.array(((1 - t)**2, 2 * t * (1 - t), t**2))

    for radius, controls in ((0.6, examples.plate_part()[0][:, 0]), (1.0, examples.quarter_part()[1][:, 1])):
        for t in np.linspace(0, 1, 7):
            x = bernstein(t) @ controls
            assert abs(np.hypot(x[0], x[1]) / x[3] - radius) < 1e-14
    middle = np.array((0, 0, examples.DIVOT_RADIUS - examples.DIVOT_DEPTH))
    for s, t in np.ndindex(5, 5):
        x = np.einsum("i,j,ijk", bernstein(s / 4), bernstein(t / 4), examples.divot_part()[-1])
        assert abs(np.linalg.norm(x[:3] / x[3] - middle) - examples.DIVOT_RADIUS) < 1e-14


def test_circles_of_a_plate():
    """Every hole is a circle, sides and area are the plate's. 8e-5 and 2e-7 of the radius: about h^4 / 400 of arcs h long."""
    area = 24 - np.pi * sum(radius**2 for radius in examples.PLATE.values() if radius)
    for n, most in ((4, 8e-5), (16, 2e-7)):
        spline, report = fit(f"plate{n}", examples.plate_part(), examples.plate_mesh(n))
        assert report["verdict"] == "valid" and report["unmatched_features"] == 0, report
        assert abs(report["area"] - area) < 10 * most, (report["area"], area)
        points = points_of(drawn(boundary(spline), 1e-7))
        seen = np.zeros(len(points), bool)
        worst = 0.0
        for place, radius in examples.PLATE.items():
            away = points[:, :2] - 2.0 * np.array(place)
            here = np.linalg.norm(away, axis=1) < 0.95
            seen |= here
            if not radius:
                assert not here.any(), place
                continue
            angles = np.sort(np.arctan2(away[here, 1], away[here, 0]))
            assert np.diff(np.append(angles, angles[0] + 2 * np.pi)).max() < 0.05, place  # all around
            worst = max(worst, np.abs(np.linalg.norm(away[here], axis=1) / radius - 1).max())
        assert worst < most, (n, worst)
        print("edges of a hole", 4 * n, "circles right to", worst)
        outside = points[~seen]
        sides = np.stack([outside[:, 0] + 1, outside[:, 0] - 5, outside[:, 1] + 1, outside[:, 1] - 3])
        assert np.abs(sides).min(0).max() < 1e-12 and np.abs(points[:, 2]).max() < 1e-12


def test_bends_of_sheet_metal_are_sharp():
    """Where the drawn surface has a sharp edge there is one of the part, and as long: both are lines between given points."""
    spline, report = fit("bracket", examples.bracket_part(), examples.bracket_mesh(2))
    assert report["verdict"] == "valid" and report["unmatched_features"] == 0, report
    assert report["mesh_max_distance"] > 0.01 and report["max_distance"] < 1e-9, report
    joined = vtkCleanPolyData()
    joined.SetInputDataObject(drawn(spline, 1e-4))
    joined.ToleranceIsAbsoluteOn()
    joined.SetAbsoluteTolerance(1e-10)
    edges = vtkFeatureEdges()
    edges.SetInputConnection(joined.GetOutputPort())
    edges.SetFeatureAngle(30)
    edges.BoundaryEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.Update()
    points = points_of(edges.GetOutput())
    segments = [[edges.GetOutput().GetCell(c).GetPointId(k) for k in (0, 1)] for c in range(edges.GetOutput().GetNumberOfCells())]
    ends = points[np.array(segments)]
    bends = examples.bracket_corners()[1:-1]
    worst, lengths = 0.0, np.zeros(len(bends))
    for pair in ends:
        distances = []
        for a, b in bends:
            along = (b - a) / np.linalg.norm(b - a)
            distances.append(np.linalg.norm(np.cross(pair - a, along), axis=1).max())
        bend = int(np.argmin(distances))
        worst = max(worst, distances[bend])
        lengths[bend] += np.linalg.norm(pair[1] - pair[0])
    print("sharp edges right to", worst)
    assert worst < 1e-9, worst
    assert np.abs(lengths - np.linalg.norm(bends[:, 1] - bends[:, 0], axis=1)).max() < 1e-9, lengths


def test_folded_plane_elements_are_mended_soon():
    """A finer mesh of the same points' errors has an element that folds in its plane, which no subdivision decides: 0.4 s, not 30."""
    _, report = fit("finer_bracket", examples.bracket_part(), examples.bracket_mesh(3), timeout=15)
    assert report["invalid_elements_before"] == 1 and report["verdict"] == "valid" and report["max_distance"] < 1e-9, report


def test_divot_in_a_brick():
    """Without smoothing elements are folded, with it none is; the surface is on planes and on the sphere either way."""
    reports = {}
    for smoothing in ("off", "certificate"):
        spline, report = fit("divot_" + smoothing, examples.divot_part(), examples.divot_mesh(2), "--degree", 2, "--smoothing", smoothing)
        reports[smoothing] = report
        points = points_of(drawn(boundary(spline), 1e-4))
        middle = (0, 0, examples.DIVOT_RADIUS - examples.DIVOT_DEPTH)
        planes = np.c_[2 - np.abs(points[:, :2]), points[:, 2] + 1, -points[:, 2]].min(1)
        sphere = np.abs(np.linalg.norm(points - middle, axis=1) - examples.DIVOT_RADIUS)
        inside = np.linalg.norm(points[:, :2], axis=1) < 0.97 * examples.DIVOT_RIM
        cap = inside & (points[:, 2] > -0.9)
        assert cap.sum() > 100
        print(smoothing, "sphere right to", sphere[cap].max())
        assert sphere[cap].max() < 4e-3, sphere[cap].max()
        assert np.abs(planes[np.linalg.norm(points[:, :2], axis=1) > 1.05 * examples.DIVOT_RIM]).max() < 1e-9
        assert abs(report["volume"] / examples.DIVOT_VOLUME - 1) < 2e-4, (report["volume"], examples.DIVOT_VOLUME)
    assert reports["off"]["verdict"] == "invalid" and reports["off"]["uncertified_elements"] >= 4, reports["off"]
    mended = reports["certificate"]
    assert mended["verdict"] == "valid" and mended["uncertified_elements"] == 0 and mended["min_jacobian_lower"] > 0, mended
    assert mended["invalid_elements_before"] == reports["off"]["uncertified_elements"], mended


def test_mended_elements_stay_at_the_target():
    """A layer so thin that no spline of so few elements is valid on the target: named, not made valid somewhere else."""
    _, report = fit("thin_layer", examples.divot_part(), examples.divot_mesh(1, 0.8, 0.03), "--degree", 2)
    print("thin layer", report["verdict"], "rms", report["rms_distance"], "of the mesh", report["mesh_rms_distance"], "volume", report["volume"])
    assert report["rms_distance"] <= 0.25 * report["mesh_rms_distance"]
    assert abs(report["volume"] / examples.DIVOT_VOLUME - 1) < 0.03


def test_quarter_of_a_disc():
    """A point of three quadrilaterals inside. Functions: 3 patches of (n + 3)^2 less what they share; rim and area of the circle."""
    n, functions = 4, {}
    for policy in ("full", "minimal"):
        spline, report = fit("quarter_" + policy, examples.quarter_part(), examples.quarter_mesh(n), "--policy", policy)
        assert report["verdict"] == "valid" and report["patches"] == 3, report
        points = points_of(drawn(boundary(spline), 1e-7))[:, :2]
        rim = np.abs(np.linalg.norm(points[points.min(1) > 1e-9], axis=1) - 1)
        print(policy, "circle right to", rim.max())
        assert len(rim) > 50 and rim.max() < 3.2e-6, rim.max()
        assert np.abs(points[points.min(1) < 1e-9].min(1)).max() < 1e-12
        assert abs(report["area"] - np.pi / 4) < 5e-6
        functions[policy] = report["functions"]
    assert functions["full"] == 3 * (n + 3)**2 - 3 * (n + 3) + 1, functions
    assert functions["minimal"] < functions["full"], functions


knotwork_testing.main(globals())
