# SPDX-License-Identifier: BSD-3-Clause
"""The job `solve` and the function of the package: a thick cylinder under pressure against Lame's solution, and errors."""
import json

import knotwork_testing
from knotwork_testing import Files

import knotwork
import numpy as np

FILES = Files("solve", 300)
INNER, OUTER = 0.5, 1.0  # of the source's ring


def cylinder():
    """A quarter of a pipe with pressure 3 inside, held along its cuts."""
    return {"material": {"youngs_modulus": 1000, "poissons_ratio": 0.3}, "conditions": [
        {"on": {"where": "abs(x) < 1e-9"}, "displacement": [0, None]},
        {"on": {"where": "abs(y) < 1e-9"}, "displacement": [None, 0]},
        {"on": {"where": "x * nx + y * ny < -0.1"}, "pressure": 3}]}


def write(name, problem):
    with open(FILES.path(name), "w", encoding="utf-8") as stream:
        json.dump(problem, stream)
    return FILES.path(name)


def lame(radius, pressure, modulus, ratio):
    """Radial displacement of a thick cylinder in plane stress. Timoshenko, Goodier, Theory of Elasticity, 1951, article 26."""
    scale = pressure * INNER ** 2 / (modulus * (OUTER ** 2 - INNER ** 2))
    return scale * ((1 - ratio) * radius + (1 + ratio) * OUTER ** 2 / radius)


def test_thick_cylinder():
    ring = FILES.path("ring.vtu")
    FILES.run("source", "--shape", "annulus-sector", "--degree", 2, "--elements", 16, 16, 1, "--output", ring)
    report = FILES.report("solve", "elasticity", ring, write("pipe.json", cylinder()), "--gauss-points", FILES.path("gauss.vtp"),
                          "--conditions", FILES.path("conditions.csv"), "--output", FILES.path("pipe.vtu"))
    exact = lame(INNER, 3, 1000, 0.3)
    assert abs(report["largest_value"] / exact - 1) < 1e-4, (report, exact)
    assert report["imbalance"] < 1e-10 and report["elements"] == 256 and report["equation"] == "elasticity"
    # hoop stress inside p (a^2 + b^2) / (b^2 - a^2) = 5, radial -3: von Mises 7, less at Gauss points beside the rim
    assert 6.6 < report["largest_von_mises"] < 7.0, report
    strain = FILES.report("solve", "elasticity", ring, FILES.path("pipe.json"), "--plane", "strain", "--output", FILES.path("pipe.vtu"))
    ratio = 0.3 / 0.7
    assert abs(strain["largest_value"] / lame(INNER, 3, 1000 / (1 - 0.09), ratio) - 1) < 1e-4, strain


def test_function():
    ring = knotwork.source("annulus-sector", degree=3, elements=[8, 8, 1])
    solved = ring.solve(equation="elasticity", problem=json.dumps(cylinder()))
    moved = solved.point_arrays["Displacement"]
    assert abs(np.linalg.norm(moved, axis=1).max() / lame(INNER, 3, 1000, 0.3) - 1) < 0.02  # of Bezier points, beside the curve
    assert solved.outputs["conditions"].columns["Kind"][2] == "pressure"
    assert solved.outputs["numbers"].columns["Imbalance"][0] < 1e-10
    heat = ring.solve(problem=json.dumps({"source": 1, "conditions": [{"on": "boundary", "value": "x * y"}]}))
    # the largest of x y on the boundary is 1 / 2, and the source adds a little inside
    assert 0.5 < heat.point_arrays["Solution"].max() < 0.6
    try:
        ring.solve(problem="{}")
    except knotwork.Error as error:
        assert "the constant" in str(error), error
    else:
        assert False, "an unsupported body was solved"


def test_functions_of_python():
    ring = knotwork.source("annulus-sector", degree=2, elements=[4, 4, 1])
    # the same problem in words of Python and as expressions
    spoken = {"source": lambda x, y, z: x * y + np.exp(x), "exact": lambda x, y, z: x + y,
              "conditions": [{"on": {"where": lambda x, y, z, nx, ny, nz: x * nx + y * ny > 0.1}, "flux": lambda x, y, z, nx, ny, nz: nx + 2 * ny},
                             {"on": {"where": lambda x, y, z: abs(x) < 1e-9}, "value": lambda *at: at[1] ** 2}]}
    written = {"source": "x * y + exp(x)", "exact": "x + y",
               "conditions": [{"on": {"where": "x * nx + y * ny > 0.1"}, "flux": "nx + 2 * ny"}, {"on": {"where": "abs(x) < 1e-9"}, "value": "y^2"}]}
    one, other = ring.solve(problem=spoken), ring.solve(problem=written)
    assert np.abs(one.point_arrays["Solution"] - other.point_arrays["Solution"]).max() < 1e-12
    assert abs(one.outputs["numbers"].columns["L2Error"][0] / other.outputs["numbers"].columns["L2Error"][0] - 1) < 1e-9

    def wrong(x, y, z):
        raise RuntimeError("no value here")

    held = {"on": "boundary", "value": 0}
    for problem, kind, words in (
            ({"source": wrong, "conditions": [held]}, RuntimeError, "no value here"),
            ({"source": lambda x: x, "conditions": [held]}, TypeError, "x, y, z"),
            ({"source": lambda x, y, z: "one", "conditions": [held]}, ValueError, "one"),
            ({"source": lambda x, y, z: range(4), "conditions": [held]}, TypeError, "4 numbers"),
            ({"source": "@heat", "conditions": [held]}, knotwork.Error, "@heat"),
            ({"source": object(), "conditions": [held]}, TypeError, "problem['source']")):
        try:
            ring.solve(problem=problem)
        except kind as error:
            assert words in str(error), error
        else:
            assert False, (problem, "was solved")


def test_a_format_that_loses_the_solution_is_refused():
    ring = FILES.path("small.vtu")
    FILES.run("source", "--shape", "annulus-sector", "--output", ring)
    done = knotwork_testing.run_program("solve", "poisson", ring, write("zero.json", {"conditions": [{"on": "boundary", "value": 0}]}),
                                        "--output", FILES.path("solved.step"))
    assert done.returncode == 1 and "change the ending" in done.stderr, done


def test_errors_are_one_line():
    ring = FILES.path("small.vtu")
    FILES.run("source", "--shape", "annulus-sector", "--output", ring)
    for problem, words in (({"conditions": [{"on": {"side": 9}, "value": 0}]}, "side 9"),
                           ({"conditions": [{"on": {"where": "While (x < 2) { 1 }"}, "value": 0}]}, "has a loop"),
                           ({"loads": 1}, "unknown key")):
        done = knotwork_testing.run_program("solve", "poisson", ring, write("wrong.json", problem), "--output", FILES.path("none.vtu"))
        assert done.returncode != 0 and len(done.stderr.splitlines()) == 1 and words in done.stderr, done
    done = knotwork_testing.run_program("solve", "heat", ring, FILES.path("wrong.json"), "--output", FILES.path("none.vtu"))
    assert done.returncode == 2 and "heat" in done.stderr, done


knotwork_testing.main(globals())
