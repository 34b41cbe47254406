# SPDX-License-Identifier: BSD-3-Clause
"""`knotwork features`: a noisy box whose edges are known, edges and regions of one's own, the same for any number of threads, refusals."""
import json

import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

N = 24


def path(name):
    return knotwork_testing.output("features/" + name)


def box(name, noise=0.0):
    """A box of 3 x 2 x 1, its faces divided, every square into two triangles with points of their own as in STL files; noise moves equal
    points alike."""
    points, triangles, numbers = [], [], {}
    for face in range(6):
        axis, upper = divmod(face, 2)
        for i in range(N):
            for j in range(N):
                corners = []
                for u, v in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                    place = [0, 0, 0]
                    place[axis] = N * upper
                    place[(axis + 1) % 3], place[(axis + 2) % 3] = (u, v) if upper else (v, u)
                    corners.append(numbers.setdefault(tuple(place), len(numbers)))
                triangles += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
    points = np.array(list(numbers), float) / N * (3, 2, 1)
    points += np.random.default_rng(5).normal(0, noise, points.shape)
    with open(path(name), "w") as stream:
        stream.write(f"OFF\n{3 * len(triangles)} {len(triangles)} 0\n")
        stream.writelines("{:.17g} {:.17g} {:.17g}\n".format(*points[corner]) for triangle in triangles for corner in triangle)
        stream.writelines(f"3 {3 * t} {3 * t + 1} {3 * t + 2}\n" for t in range(len(triangles)))
    return path(name)


def run(*arguments, status=0):
    done = knotwork_testing.run_program("features", *arguments, "--report", path("report.json"), "--quiet")
    assert done.returncode == status, (arguments, done.stderr)
    if status:
        return done.stderr
    with open(path("report.json")) as stream:
        return json.load(stream)


def read(name):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path(name))
    reader.Update()
    return reader.GetOutput()


def numbers(report):
    return tuple(report[key] for key in ("sharp_edges", "chains", "closed_chains", "corners", "regions"))


def test_box_with_and_without_noise():
    exact = run(box("exact.off"), "--output", path("exact.vtp"))
    assert numbers(exact) == (12 * N, 12, 0, 8, 6) and exact["noise_level"] < 1e-12, exact
    noise = 2e-3 * 14 ** 0.5
    report = run(box("noisy.off", noise), "--output", path("noisy.vtp"), "--lines", path("lines.vtp"), "--corners", path("corners.vtp"))
    assert numbers(report)[1:] == (12, 0, 8, 6) and abs(report["noise_level"] / noise - 1) < 0.2, report
    lines = read("lines.vtp")
    assert lines.GetNumberOfLines() == 12 and read("corners.vtp").GetNumberOfVerts() == 8
    lengths = np.sort(vtk_to_numpy(lines.GetCellData().GetArray("Length")))
    assert np.abs(lengths / np.repeat((1, 2, 3), 4) - 1).max() < 0.15, lengths
    assert np.abs(vtk_to_numpy(lines.GetCellData().GetArray("MeanAngle")) - 90).max() < 5
    faces = np.repeat(np.arange(6), 2 * N * N)
    regions = vtk_to_numpy(read("noisy.vtp").GetCellData().GetArray("RegionId"))
    assert np.mean([np.bincount(regions[faces == face]).max() for face in range(6)]) > 0.99 * 2 * N * N
    # by the normals of the triangles there are hundreds
    assert run(path("noisy.off"), "--noise-level", 0, "--output", path("plain.vtp"))["regions"] > 100


def test_lines_and_regions_come_back():
    mesh = box("noisy.off", 2e-3 * 14 ** 0.5)
    first = run(mesh, "--output", path("first.vtp"), "--lines", path("lines.vtp"))
    again = run(mesh, "--edges", path("lines.vtp"), "--mode", "replace", "--output", path("again.vtp"))
    assert again["edges"] == path("lines.vtp")
    assert numbers(again) == numbers(first), (numbers(again), numbers(first))
    by_regions = run(path("first.vtp"), "--region-array", "RegionId", "--mode", "replace", "--output", path("again.vtp"))
    assert numbers(by_regions) == numbers(first)


def test_threads_do_not_matter():
    mesh = box("noisy.off", 5e-3)
    for threads in (1, 2, 5):
        run(mesh, "--threads", threads, "--output", path(f"threads{threads}.vtp"), "--lines", path(f"lines{threads}.vtp"))
    for name in ("threads{}.vtp", "lines{}.vtp"):
        contents = [open(path(name.format(threads)), "rb").read() for threads in (1, 2, 5)]
        assert contents[0] == contents[1] == contents[2], name


def test_refusals():
    mesh = box("exact.off")
    for options, words in ((("--sharp-angle", 10), "WeakAngle must be above 0 and at most SharpAngle; it is 20 degrees and SharpAngle 10"),
                           (("--mode", "replace"), "none are given; give edges"), (("--region-array", "Parts"), "no cell array 'Parts'"),
                           (("--edges", mesh), "no lines")):
        assert words in run(mesh, *options, "--output", path("none.vtp"), status=1), options
    with open(path("far.csv"), "w") as stream:
        stream.write("x,y,z\n0,0,0\n")
    assert "have no lines" in run(mesh, "--edges", path("far.csv"), "--output", path("none.vtp"), status=1)


knotwork_testing.main(globals())
