# SPDX-License-Identifier: BSD-3-Clause
"""LR surfaces from the command line: files there and back, values, refinement, dependence, parts."""
import os

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import knotwork_testing
import skeletons
from lr_runs import local_square, path, run, there_and_back, uniform, values


def test_there_and_back():
    surface = local_square()
    there_and_back(surface)
    assert np.abs(values(path("third.g2"), uniform()) - values(surface, uniform())).max() <= 1e-14


def test_local_spaces():
    lr = run("info", local_square("lr"))
    thb = run("info", local_square("thb"))
    assert lr["kinds"] == ["LR"] and thb["kinds"] == ["THB"]
    assert lr["dependences"] == thb["dependences"] == ["independent"]
    assert np.abs(values(path("local.g2"), uniform()) - values(path("square.vtu"), uniform())).max() <= 1e-14
    counts = {}
    for strategy in ("full-span", "minimum-span", "structured-mesh", "restricted-mesh"):
        for target in ("elements", "functions"):
            run("refine", path("square.vtu"), "--sphere", -0.4, 0, 0, 0.1, "--local-space", "lr", "--lr-strategy", strategy,
                "--lr-target", target, "--lr-directions", "both", "--keep-independent", "true", "--output", path("fine.vtu"))
            counts[strategy, target] = run("info", path("fine.vtu"))["functions"]
            assert np.abs(values(path("fine.vtu"), uniform()) - values(path("square.vtu"), uniform())).max() <= 1e-14
    assert counts["minimum-span", "elements"] < counts["full-span", "elements"], counts
    assert counts["minimum-span", "functions"] < counts["structured-mesh", "functions"], counts
    assert counts["restricted-mesh", "elements"] < counts["structured-mesh", "elements"], counts


def test_derivatives_from_below_and_above():
    """z = |u - 1 / 3| on a square of 3 x 2 bilinear elements, as g2: -1 from below and 1 from above its fold."""
    head = "200 1 0 0\n3 0\n4 2\n0 0 1 2 3 3\n3 2\n0 0 1 2 2\n"
    with open(path("fold.g2"), "w", encoding="ascii") as file:
        file.write(head + "".join(f"{i} {j} {abs(i - 1)}\n" for j in range(3) for i in range(4)))
    at = skeletons.write(skeletons.polydata([np.array([[1.0, 0.5], [1.5, 0.5], [1.0, 1.0]])]), path("fold_at.vtp"))
    for side, slopes in ((0, [1, 1, 1]), (1, [-1, 1, -1])):
        run("evaluate", path("fold.g2"), at, "--derivatives", 1, "--from-below", side, 0, 0, "--patch-id-array", "none",
            "--output", path("fold.vtp"))
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(path("fold.vtp"))
        reader.Update()
        assert vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("Derivative_u"))[:, 2].tolist() == slopes


def test_segments_are_mesh_lines():
    """In any order the same file; what is no segment is one line and the surface stays."""
    local_square()
    rows = ["0,0.3,0,0.5,1", "1,0.25,0.3,1,1", "1,0.5,0,1,2"]
    for name, lines in (("first", rows), ("second", rows[::-1] + rows)):
        with open(path(name + ".csv"), "w", encoding="ascii") as file:
            file.write("\n".join(["Direction,Value,Start,End,Multiplicity", *lines]) + "\n")
        report = run("refine", path("square.vtu"), "--segments", path(name + ".csv"), "--output", path(name + ".vtu"))
        assert report["segments"].endswith(name + ".csv")
        assert np.abs(values(path(name + ".vtu"), uniform()) - values(path("square.vtu"), uniform())).max() <= 1e-14
    with open(path("first.vtu"), "rb") as first, open(path("second.vtu"), "rb") as second:
        assert first.read() == second.read()
    assert run("info", path("first.vtu"))["kinds"] == ["LR"]
    for lines, words in ((["Direction,Value,Start,End", "0,0.3,0,0.47"], "no mesh line for it to end at"),
                         (["Direction,Value,Start", "0,0.3,0"], "no column End"), (["0,0.3,0,0.5"], "does not name the columns"),
                         (["Direction,Value,Start,End", "0,x,0,1"], "line 2, column 2"), ([], "no numbers"),
                         (["Direction,Value,Start,End", "0,0.3,0,0.5,1"], "5 columns")):
        with open(path("bad.csv"), "w", encoding="ascii") as file:
            file.write("\n".join(lines) + "\n")
        done = knotwork_testing.run_program("refine", path("square.vtu"), "--segments", path("bad.csv"), "--output", path("no.vtu"))
        assert done.returncode == 1 and done.stderr.count("\n") == 1 and words in done.stderr, done.stderr


def test_parts_and_curves():
    surface = local_square()
    box = np.array([[0.2, 0.7], [0.1, 0.5]])
    part = box[:, 0] + uniform() * (box[:, 1] - box[:, 0])
    run("extract", surface, "--box", *box.ravel(), "--output", path("part.g2"))
    assert np.abs(values(path("part.g2"), part) - values(surface, part)).max() <= 1e-14
    run("extract", surface, "--swap-parameters", "true", "--reverse-first", "true", "--output", path("turned.vtu"))
    turned = np.column_stack([1.0 - uniform()[:, 1], uniform()[:, 0]])
    assert np.abs(values(path("turned.vtu"), turned) - values(surface, uniform())).max() <= 1e-14
    run("extract", surface, "--domain", 0, 8, -1, 1, "--output", path("moved.g2"))
    moved = np.column_stack([8 * uniform()[:, 0], 2 * uniform()[:, 1] - 1])
    assert np.abs(values(path("moved.g2"), moved) - values(surface, uniform())).max() <= 1e-13
    run("extract", surface, "--expand-to-tensor", "true", "--output", path("tensor.g2"))
    assert run("info", path("tensor.g2"))["kinds"] == ["tensor-product"]
    assert np.abs(values(path("tensor.g2"), uniform()) - values(surface, uniform())).max() <= 1e-14
    run("extract", surface, "--iso-curve", "second", "--iso-value", 0.3, "--output", path("curve.vtu"))
    along = np.column_stack([uniform()[:, 0], np.full(300, 0.3)])
    assert np.abs(values(path("curve.vtu"), along * [1, 0]) - values(surface, along)).max() <= 1e-14
    # the nearest point of an LR surface
    report = run("evaluate", surface, path("on.vtp"), "--output", path("near.vtp"), "--mode", "probe")
    assert report["max_distance"] <= 1e-14


def test_bad_requests_are_one_line():
    surface = local_square()
    for arguments, words in (
            (["--domain", 1, 0, 0, 1], "direction 0"), (["--box", 0.2, 0.2, 0, 1], "direction 0"), (["--box", "nan", 0.2, 0, 1], "direction 0"),
            (["--iso-curve", "first", "--iso-value", 3], "outside"), (["--iso-curve", "first", "--iso-value", "nan"], "outside")):
        done = knotwork_testing.run_program("extract", surface, *arguments, "--output", path("no.vtu"))
        assert done.returncode == 1 and done.stderr.count("\n") == 1 and words in done.stderr, done.stderr
        assert not os.path.exists(path("no.vtu"))
    done = knotwork_testing.run_program("extract", local_square("thb"), "--output", path("no.vtu"))
    assert done.returncode == 1 and "hierarchical" in done.stderr.lower() or "locally refined" in done.stderr, done.stderr


knotwork_testing.main(globals())
