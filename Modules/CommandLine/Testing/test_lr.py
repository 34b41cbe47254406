# SPDX-License-Identifier: BSD-3-Clause
"""LR surfaces from the command line: files there and back, values, refinement, dependence, parts."""
import json
import os

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import knotwork_testing
import skeletons

CASES = {  # elements, functions
    "lr1_function_biquadratic": (53, 75), "lr2_3d_deg3x2_double_lines": (58, 100), "lr3_rational_cylinder_tp": (9, 25),
    "lr4_rational_cylinder_local": (28, 46), "lr5_linearly_dependent": (61, 82)}
# the folder is not part of the sources
FOLDER = os.path.join(os.environ.get("KNOTWORK_LR_CASES", ""), "oracle")


def path(name):
    return knotwork_testing.output("cli_lr/" + name)


def text(name):
    with open(name) as stream:
        return stream.read()


def run(*arguments):
    report = path("report.json")
    done = knotwork_testing.run_program(*arguments, "--report", report, "--quiet")
    assert done.returncode == 0, (arguments, done.stderr)
    return json.loads(text(report))


def values(surface, parameters):
    """Points of a surface at parameters."""
    at = skeletons.write(skeletons.polydata([parameters]), path("at.vtp"))
    run("evaluate", surface, at, "--output", path("on.vtp"), "--patch-id-array", "none")
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path("on.vtp"))
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPoints().GetData()).copy()


def uniform(n=300):
    return np.random.default_rng(7).random((n, 2))


def local_square(space="lr"):
    """A biquadratic square, bent by nothing, with one corner refined."""
    run("source", "--shape", "square", "--degree", 2, "--elements", 6, 6, 1, "--size", 2, 1, 1, "--output", path("square.vtu"))
    report = run("refine", path("square.vtu"), "--sphere", -0.4, 0, 0, 0.1, "--local-space", space, "--output", path("local.g2"
                 if space == "lr" else "local.vtu"))
    assert report["local_space"] == space
    return path("local.g2" if space == "lr" else "local.vtu")


def test_reference_surfaces_there_and_back():
    if not os.path.isdir(FOLDER):
        print("skipped: KNOTWORK_LR_CASES does not name the folder of the LR cases")
        return
    for name, (elements, functions) in CASES.items():
        given = os.path.join(FOLDER, name + ".g2")
        info = run("info", given)
        assert info["kinds"] == ["LR"] and (info["elements"], info["functions"]) == (elements, functions), (name, info)
        assert info["dependences"] == ["dependent" if name.startswith("lr5") else "independent"], (name, info)
        run("convert", given, "--output", path("first.g2"))
        run("convert", path("first.g2"), "--output", path("second.g2"))
        run("convert", path("first.g2"), "--output", path("grid.vtu"))
        run("convert", path("grid.vtu"), "--output", path("third.g2"))
        assert text(path("first.g2")) == text(path("second.g2")) == text(path("third.g2")), name
        table = np.loadtxt(os.path.join(FOLDER, name + ".eval.txt"))
        for file in (given, path("third.g2"), path("grid.vtu")):
            points = values(file, table[:, :2])
            # 17 given digits; numbers of size 10 at most
            assert np.abs(points - table[:, 2:]).max() <= 1e-13 * max(1.0, np.abs(table).max()), (name, file)


def test_dependence_is_resolved():
    if not os.path.isdir(FOLDER):
        print("skipped: KNOTWORK_LR_CASES does not name the folder of the LR cases")
        return
    given = os.path.join(FOLDER, "lr5_linearly_dependent.g2")
    domain = np.loadtxt(os.path.join(FOLDER, "lr5_linearly_dependent.eval.txt"))[:, :2].max(axis=0)
    run("refine", given, "--number-of-refinements", 0, "--keep-independent", "true", "--output", path("resolved.g2"))
    info = run("info", path("resolved.g2"))
    assert info["dependences"] == ["independent"] and info["functions"] >= 82  # one relation fewer, as many functions
    parameters = uniform() * domain
    assert np.abs(values(given, parameters) - values(path("resolved.g2"), parameters)).max() <= 1e-13
    done = knotwork_testing.run_program("info", given)
    assert "dependent" in done.stdout and "--keep-independent" in done.stdout


def test_local_spaces():
    lr = run("info", local_square("lr"))
    thb = run("info", local_square("thb"))
    assert lr["kinds"] == ["LR"] and thb["kinds"] == ["THB"]
    assert lr["dependences"] == thb["dependences"] == ["independent"]
    assert np.abs(values(path("local.g2"), uniform()) - values(path("square.vtu"), uniform())).max() <= 1e-14
    counts = {}
    for strategy in ("full-span", "minimum-span", "structured-mesh"):
        for target in ("elements", "functions"):
            run("refine", path("square.vtu"), "--sphere", -0.4, 0, 0, 0.1, "--local-space", "lr", "--lr-strategy", strategy,
                "--lr-target", target, "--lr-directions", "both", "--keep-independent", "true", "--output", path("fine.vtu"))
            counts[strategy, target] = run("info", path("fine.vtu"))["functions"]
            assert np.abs(values(path("fine.vtu"), uniform()) - values(path("square.vtu"), uniform())).max() <= 1e-14
    assert counts["minimum-span", "elements"] < counts["full-span", "elements"], counts
    assert counts["minimum-span", "functions"] < counts["structured-mesh", "functions"], counts


def test_parts_and_curves():
    surface = local_square()
    box = np.array([[0.2, 0.7], [0.1, 0.5]])
    part = box[:, 0] + uniform() * (box[:, 1] - box[:, 0])
    run("extract", surface, "--box", *box.ravel(), "--output", path("part.g2"))
    assert np.abs(values(path("part.g2"), part) - values(surface, part)).max() <= 1e-14
    run("extract", surface, "--swap-parameters", "true", "--reverse-first", "true", "--output", path("turned.vtu"))
    turned = np.column_stack([1.0 - uniform()[:, 1], uniform()[:, 0]])
    assert np.abs(values(path("turned.vtu"), turned) - values(surface, uniform())).max() <= 1e-14
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
            (["--box", 0.2, 0.2, 0, 1], "direction 0"), (["--box", "nan", 0.2, 0, 1], "direction 0"),
            (["--iso-curve", "first", "--iso-value", 3], "outside"), (["--iso-curve", "first", "--iso-value", "nan"], "outside")):
        done = knotwork_testing.run_program("extract", surface, *arguments, "--output", path("no.vtu"))
        assert done.returncode == 1 and done.stderr.count("\n") == 1 and words in done.stderr, done.stderr
        assert not os.path.exists(path("no.vtu"))
    done = knotwork_testing.run_program("extract", local_square("thb"), "--output", path("no.vtu"))
    assert done.returncode == 1 and "hierarchical" in done.stderr.lower() or "locally refined" in done.stderr, done.stderr


knotwork_testing.main(globals())
