# SPDX-License-Identifier: BSD-3-Clause
"""Scans moved onto a STEP file: from files to files by the job, and in Python; a scan of a real part. Oracle: the motion that moved them."""
import json
import os

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkCylinderSource

FOLDER = os.path.dirname(knotwork_testing.output("rigid_alignment/files"))
SHARED = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "..", "..", "shared", "data"))


def mesh_of(points, triangles):
    mesh = vtkPolyData()
    vertices = vtkPoints()
    vertices.SetDataTypeToDouble()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    cells = vtkCellArray()
    for triangle in triangles:
        cells.InsertNextCell(3, [int(corner) for corner in triangle])
    mesh.SetPoints(vertices)
    mesh.SetPolys(cells)
    return mesh


def step():
    """Triangles of an L of planes with a slanted end: (0, 0) to (4, 3), 1.5 high."""
    outline = np.array([(0, 0), (4, 0), (4.5, 1), (1, 1), (1, 3), (0, 3)], float)
    points = np.r_[np.c_[outline, np.zeros(6)], np.c_[outline, np.full(6, 1.5)]]
    cap = [(0, 1, 3), (1, 2, 3), (0, 3, 5), (3, 4, 5)]
    triangles = [(a, c, b) for a, b, c in cap] + [(a + 6, b + 6, c + 6) for a, b, c in cap]
    for i in range(6):
        j = (i + 1) % 6
        triangles += [(i, j, j + 6), (i, j + 6, i + 6)]
    return points, np.array(triangles)


def motion(seed, shift=30.0):
    random = np.random.default_rng(seed)
    q, r = np.linalg.qr(random.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    q[:, 0] *= np.linalg.det(q)
    return q, random.uniform(-shift, shift, 3)


def cloud(points, triangles, count, noise, outliers, seed):
    """Points on triangles with noise, then some anywhere in their box."""
    random = np.random.default_rng(seed)
    corners = points[triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = corners[random.choice(len(triangles), count, p=areas / areas.sum())]
    b, c = random.random(count), random.random(count)
    b, c = np.where(b + c > 1, 1 - b, b), np.where(b + c > 1, 1 - c, c)
    on = chosen[:, 0] + b[:, None] * (chosen[:, 1] - chosen[:, 0]) + c[:, None] * (chosen[:, 2] - chosen[:, 0])
    off = random.uniform(points.min(axis=0), points.max(axis=0), (int(outliers * count), 3))
    return np.r_[on + noise * random.normal(size=on.shape), off]


def job(scan, target, *words):
    done = knotwork_testing.run_program("align", scan, "--to", target, "--output", "aligned.vtp", "--report", "report.json", *words,
                                        folder=FOLDER)
    assert done.returncode == 0, done.stderr
    with open(os.path.join(FOLDER, "report.json"), encoding="utf-8") as file:
        return done, json.load(file)


def write_part():
    """The part as a STEP file of six sides and two caps."""
    points, triangles = step()
    knotwork.write(mesh_of(points, triangles), os.path.join(FOLDER, "part.vtp"))
    done = knotwork_testing.run_program("trim", "part.vtp", "--output", "part.step", folder=FOLDER)
    assert done.returncode == 0, done.stderr
    return points, triangles


def test_cloud_onto_a_step_file():
    points, triangles = write_part()
    turn, shift = motion(1)
    noise, count = 0.005, 4000
    scan = cloud(points, triangles, count, noise, 0.2, 2) @ turn.T + shift
    np.savetxt(os.path.join(FOLDER, "scan.xyz"), scan, fmt="%.17g")
    _, report = job("scan.xyz", "part.step")
    matrix = np.array(report["motion"]).reshape(4, 4)
    back = (points @ turn.T + shift) @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.abs(back - points).max() < 15 * noise / np.sqrt(count), np.abs(back - points).max()
    assert report["converged"] is True and report["ambiguous"] is False and report["signed"] is True
    assert report["equal_poses"] == 1 and report["points"] == 4800
    assert abs(report["inlier_rms"] / noise - 1) < 0.2 and 0.8 < report["inlier_fraction"] < 0.92
    assert report["percentile_levels"] == [50, 90, 95, 99, 99.9, 100]
    distance = vtk_to_numpy(knotwork.read(os.path.join(FOLDER, "aligned.vtp")).GetPointData().GetArray("Distance"))
    assert abs(np.sqrt(np.mean(distance**2)) - report["rms_distance"]) < 1e-12
    assert report["percentiles"][-1] == np.abs(distance).max()
    assert report["percentiles"][0] == np.sort(np.abs(distance))[2399]
    # points of the noise lie on both sides; those anywhere are inside and outside of the part
    assert report["min_distance"] < -0.1 and report["max_distance"] > 0.1


def test_filter_takes_any_pose():
    points, triangles = step()
    filter = knotwork.vtkRigidAlignment()
    filter.SetTargetData(mesh_of(points, triangles))
    for seed in range(5):
        turn, shift = motion(seed)
        filter.SetInputDataObject(mesh_of(points @ turn.T + shift, triangles))
        filter.Update()
        assert filter.GetErrorCode() == 0
        back = vtk_to_numpy(filter.GetOutputDataObject(0).GetPoints().GetData())
        assert np.abs(back - points).max() < 1e-8, seed


def test_turned_part_is_ambiguous():
    source = vtkCylinderSource()
    source.SetResolution(64)
    source.SetOutputPointsPrecision(1)
    source.Update()
    knotwork.write(source.GetOutput(), os.path.join(FOLDER, "pin.vtp"))
    done = knotwork_testing.run_program("trim", "pin.vtp", "--output", "pin.step", folder=FOLDER)
    assert done.returncode == 0, done.stderr
    done, report = job("pin.vtp", "pin.step")
    assert report["ambiguous"] is True and report["free_motions"] == 1 and report["equal_poses"] == 0
    assert "slide" in done.stderr


def test_errors_of_the_job():
    write_part()
    for words, said in ((("part.vtp",), "--to"), (("part.vtp", "--to", "none.step"), "none.step")):
        done = knotwork_testing.run_program("align", *words, "--output", "x.vtp", folder=FOLDER)
        assert done.returncode == 1 and said in done.stderr, done.stderr
        assert not os.path.exists(os.path.join(FOLDER, "x.vtp"))


def test_real_part():
    file = os.path.join(SHARED, "unstructured", "cmu_mount1_target.off")
    if not os.path.exists(file):
        print("left out: shared/data/unstructured/cmu_mount1_target.off does not stand beside the tree")
        return
    mesh = knotwork.read(file)
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
    size = np.linalg.norm(np.ptp(points, axis=0))
    turn, shift = motion(4, 3 * size)
    noise = 1e-3 * size
    moved = points @ turn.T + shift + noise * np.random.default_rng(1).normal(size=points.shape)
    np.savetxt(os.path.join(FOLDER, "real.xyz"), moved, fmt="%.17g")
    _, report = job("real.xyz", file)
    matrix = np.array(report["motion"]).reshape(4, 4)
    back = (points @ turn.T + shift) @ matrix[:3, :3].T + matrix[:3, 3]
    print("real part:", len(points), "points, error", np.abs(back - points).max() / noise * np.sqrt(len(points)), "noise / sqrt(n)")
    assert np.abs(back - points).max() < 15 * noise / np.sqrt(len(points))


knotwork_testing.main(globals())
