# SPDX-License-Identifier: BSD-3-Clause
"""A ball as spline and as tetrahedra of orders 1 to 3, from files to files; what is said of bad input."""
import json
import math
import os

import knotwork_testing

FOLDER = os.path.dirname(knotwork_testing.output("compare/files"))


def run(*words, status=0):
    done = knotwork_testing.run_program(*words, folder=FOLDER)
    assert done.returncode == status, (words, done.stderr)
    return done


def report(*words):
    run(*words, "--report", "report.json", "--force")
    with open(os.path.join(FOLDER, "report.json"), encoding="utf-8") as file:
        return json.load(file)


def test_a_ball():
    run("source", "--shape", "ball", "--output", "ball.vtu", "--force")
    errors = []
    for order in (1, 2):
        run("tetrahedralize", "ball.vtu", "--chordal-tolerance", "0.02", "--order", order, "--output", "tets.vtu", "--force")
        found = report("compare", "ball.vtu", "tets.vtu", "--reference", "ball.vtu", "--output", "table.csv",
                       "--histogram", "histogram.csv", "--spline-boundary", "spline.vtp", "--mesh-boundary", "mesh.vtp")
        assert abs(found["reference_volume"] - 4 / 3 * math.pi) < 1e-9, found
        assert found["spline_volume_error"] < 1e-9 and found["spline_largest_distance"] < 1e-3, found
        assert found["mesh_valid_elements"] == found["mesh_elements"] > 0, found
        assert found["mesh_scaled_jacobian_lower"] <= found["mesh_scaled_jacobian_upper"] <= 1, found
        expected = 1 - found["mesh_volume"] / (4 / 3 * math.pi)
        assert abs(found["mesh_volume_error"] - abs(expected)) < 1e-9, found
        with open(os.path.join(FOLDER, "table.csv"), encoding="utf-8") as file:
            assert len(file.read().splitlines()) == 3
        errors.append((found["mesh_volume_error"], found["mesh_to_reference"]))
    assert errors[1][0] < 0.1 * errors[0][0] and errors[1][1] < 0.25 * errors[0][1], errors


def test_bad_input_is_named():
    run("source", "--shape", "cube", "--output", "cube.vtu", "--force")
    run("source", "--output", "square.vtu", "--force")
    for words, part in ((("cube.vtu", "square.vtu"), "square.vtu"), (("cube.vtu", "cube.vtu", "--reference", "square.vtu"), "bounds no solid")):
        done = run("compare", *words, "--output", "no.csv", status=1)
        assert part in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr
        assert not os.path.exists(os.path.join(FOLDER, "no.csv"))


knotwork_testing.main(globals())
