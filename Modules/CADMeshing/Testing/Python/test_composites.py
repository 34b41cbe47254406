# SPDX-License-Identifier: BSD-3-Clause
"""A bracket of bent sheet, from files to files: both sides of the sheet as composites, meshed as one face each, fitted to a spline solid."""
import json
import os

import knotwork_testing
import numpy as np
from quad_checks import check_solids, meshed
from vtkmodules.util.numpy_support import vtk_to_numpy

FOLDER = os.path.dirname(knotwork_testing.output("composites/files"))
BRACKET = knotwork_testing.data(os.path.join("Parts", "bracket.step"))
VOLUME, AREA = 7790.1239, 8607.4701  # of OpenCASCADE
SIDES = ("--composite", "1,5,7,15,16", "--composite", "3,12,13,18,19", "--split-plane", "6,8", 60, 0, 0, 1, 0, 0)


def composed():
    done = knotwork_testing.run_program("cadmodify", BRACKET, *SIDES, "--output", "sides.step", "--force", folder=FOLDER)
    assert done.returncode == 0, done.stderr
    return meshed(FOLDER, "sides.step", "--edge-length", 4)


def from_sheet(points):
    """Distance from the planes and cylinders that the two sides of the sheet consist of, of the one that is next."""
    x, y, z = points.T
    outside = [np.abs(z), np.abs(x - 65), np.abs(y - 45), np.abs(np.hypot(x - 60, z - 5) - 5), np.abs(np.hypot(y - 40, z - 5) - 5)]
    inside = [np.abs(z - 2), np.abs(x - 63), np.abs(y - 43), np.abs(np.hypot(x - 60, z - 5) - 3), np.abs(np.hypot(y - 40, z - 5) - 3)]
    return np.min(outside + inside, 0)


def along_bends(mesh):
    """Sides of quadrilaterals along the four straight lines where the bends of the inner side begin and end."""
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    quads = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 4)
    sides = np.unique(np.sort(np.stack([quads, np.roll(quads, -1, 1)], 2).reshape(-1, 2), 1), axis=0)
    x, y, z = points.T
    lines = [(np.abs(x - 60) + np.abs(z - 2) < 1e-6), (np.abs(x - 63) + np.abs(z - 5) < 1e-6), (np.abs(y - 40) + np.abs(z - 2) < 1e-6) & (x > 14.9) & (x < 31.1),
             (np.abs(y - 43) + np.abs(z - 5) < 1e-6)]
    return sum(int((line[sides[:, 0]] & line[sides[:, 1]]).sum()) for line in lines)


def test_quadrilaterals_pass_over_the_bends_and_lie_on_the_faces():
    _, before = meshed(FOLDER, BRACKET, "--edge-length", 4)
    assert along_bends(before) > 20, along_bends(before)
    report, mesh = composed()
    check_solids(report, mesh, -4)  # two holes and a slot
    assert report["faces"] == 19 and sorted(face["joined_faces"] for face in report["face_table"])[-3:] == [0, 5, 5], report["face_table"]
    assert along_bends(mesh) == 0, along_bends(mesh)
    dimension = vtk_to_numpy(mesh.GetPointData().GetArray("CADEntityDimension"))
    entity = vtk_to_numpy(mesh.GetPointData().GetArray("CADEntityId"))
    groups = [face["face_id"] for face in report["face_table"] if face["composite"]]
    inner = vtk_to_numpy(mesh.GetPoints().GetData())[(dimension == 2) & np.isin(entity, groups)]
    assert len(inner) > 1000 and from_sheet(inner).max() < 1e-9, (len(inner), from_sheet(inner).max())


def test_the_mesh_becomes_a_valid_spline_solid():
    composed()
    done = knotwork_testing.run_program("cadfit", "quads.vtp", "--target", BRACKET, "--degree", 2, "--output", "bracket.vtu", "--report", "fit.json", "--force",
                                        folder=FOLDER, timeout=600)
    assert done.returncode == 0, done.stderr
    with open(os.path.join(FOLDER, "fit.json"), encoding="utf-8") as file:
        fit = json.load(file)
    assert fit["verdict"] == "valid" and fit["uncertified_elements"] == 0, fit
    assert fit["max_distance"] < 0.06 and fit["max_distance_back"] < 0.06, fit  # of a sheet of 2, 86 across
    assert abs(fit["volume"] / VOLUME - 1) < 5e-5 and abs(fit["area"] / AREA - 1) < 5e-5, (fit["volume"], fit["area"])


def test_a_closed_composite_is_warned_of():
    every = ",".join(map(str, range(25)))
    done = knotwork_testing.run_program("cadmodify", BRACKET, "--composite", every, "--output", "closed.step", "--force", folder=FOLDER)
    assert done.returncode == 0, done.stderr
    done = knotwork_testing.run_program("quads", "closed.step", "--edge-length", 8, "--output", "closed.vtp", "--force", folder=FOLDER)
    assert done.returncode == 0 and "composite 1 (face 0 and others) stays in its faces" in done.stderr, done.stderr


def test_hexahedra_pass_over_the_bends():
    """One face to the other through the sheet: composites are ends, and no edges of the mesh lie between their faces."""
    done = knotwork_testing.run_program("cadmodify", BRACKET, *SIDES, "--output", "sides.step", "--force", folder=FOLDER)
    assert done.returncode == 0, done.stderr
    done = knotwork_testing.run_program("hexes", "sides.step", "--edge-length", 4, "--output", "hexes.vtu", "--report", "hexes.json", "--force", folder=FOLDER)
    assert done.returncode == 0, done.stderr
    with open(os.path.join(FOLDER, "hexes.json"), encoding="utf-8") as file:
        report = json.load(file)
    (solid,) = report["solid_table"]
    assert report["verdict"] == "valid" and report["valid_cells"] == report["hexahedra"] and not report["cuts"], report
    assert len(solid["source_faces"].split()) == len(solid["target_faces"].split()) == 1, solid
    done = knotwork_testing.run_program("cadfit", "hexes.vtu", "--target", BRACKET, "--degree", 2, "--output", "sheet.vtu", "--report", "fit.json", "--force",
                                        folder=FOLDER, timeout=600)
    assert done.returncode == 0, done.stderr
    with open(os.path.join(FOLDER, "fit.json"), encoding="utf-8") as file:
        fitted = json.load(file)
    assert fitted["verdict"] == "valid" and abs(fitted["volume"] - VOLUME) < 1e-3 * VOLUME, fitted


knotwork_testing.main(globals())
