# SPDX-License-Identifier: BSD-3-Clause
"""LR surfaces of another program with its own values, where the environment variable KNOTWORK_LR_CASES names their folder."""
import os

import numpy as np

import knotwork_testing
from lr_runs import path, run, there_and_back, uniform, values

CASES = {  # elements, functions
    "lr1_function_biquadratic": (53, 75), "lr2_3d_deg3x2_double_lines": (58, 100), "lr3_rational_cylinder_tp": (9, 25),
    "lr4_rational_cylinder_local": (28, 46), "lr5_linearly_dependent": (61, 82)}
FOLDER = os.path.join(os.environ.get("KNOTWORK_LR_CASES", ""), "oracle")
if not os.path.isdir(FOLDER):
    knotwork_testing.skip("KNOTWORK_LR_CASES does not name the folder of the LR cases")


def test_reference_surfaces_there_and_back():
    for name, (elements, functions) in CASES.items():
        given = os.path.join(FOLDER, name + ".g2")
        info = run("info", given)
        assert info["kinds"] == ["LR"] and (info["elements"], info["functions"]) == (elements, functions), (name, info)
        assert info["dependences"] == ["dependent" if name.startswith("lr5") else "independent"], (name, info)
        there_and_back(given)
        table = np.loadtxt(os.path.join(FOLDER, name + ".eval.txt"))
        for file in (given, path("third.g2"), path("grid.vtu")):
            points = values(file, table[:, :2])
            # 17 given digits; numbers of size 10 at most
            assert np.abs(points - table[:, 2:]).max() <= 1e-13 * max(1.0, np.abs(table).max()), (name, file)


def test_dependence_is_resolved():
    given = os.path.join(FOLDER, "lr5_linearly_dependent.g2")
    domain = np.loadtxt(os.path.join(FOLDER, "lr5_linearly_dependent.eval.txt"))[:, :2].max(axis=0)
    run("refine", given, "--number-of-refinements", 0, "--keep-independent", "true", "--output", path("resolved.g2"))
    info = run("info", path("resolved.g2"))
    assert info["dependences"] == ["independent"] and info["functions"] >= 82  # one relation fewer, as many functions
    parameters = uniform() * domain
    assert np.abs(values(given, parameters) - values(path("resolved.g2"), parameters)).max() <= 1e-13
    done = knotwork_testing.run_program("info", given)
    assert "dependent" in done.stdout and "--keep-independent" in done.stdout


knotwork_testing.main(globals())
