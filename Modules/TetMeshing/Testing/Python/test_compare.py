# SPDX-License-Identifier: BSD-3-Clause
"""A ball as spline and as tetrahedra of orders 1 to 3, from files to files; what is said of bad input."""
import math
import os

import knotwork_testing

FILES = knotwork_testing.Files("compare")


def test_a_ball():
    FILES.run("source", "--shape", "ball", "--output", "ball.vtu", "--force")
    errors = []
    for order in (1, 2):
        FILES.run("tetrahedralize", "ball.vtu", "--chordal-tolerance", "0.02", "--order", order, "--output", "tets.vtu", "--force")
        found = FILES.report("compare", "ball.vtu", "tets.vtu", "--reference", "ball.vtu", "--output", "table.csv",
                       "--histogram", "histogram.csv", "--spline-boundary", "spline.vtp", "--mesh-boundary", "mesh.vtp")
        assert abs(found["reference_volume"] - 4 / 3 * math.pi) < 1e-9, found
        assert found["spline_volume_error"] < 1e-9 and found["spline_largest_distance"] < 1e-3, found
        assert found["mesh_valid_elements"] == found["mesh_elements"] > 0, found
        assert found["mesh_scaled_jacobian_lower"] <= found["mesh_scaled_jacobian_upper"] <= 1, found
        expected = 1 - found["mesh_volume"] / (4 / 3 * math.pi)
        assert abs(found["mesh_volume_error"] - abs(expected)) < 1e-9, found
        with open(FILES.path("table.csv"), encoding="utf-8") as file:
            assert len(file.read().splitlines()) == 3
        errors.append((found["mesh_volume_error"], found["mesh_to_reference"]))
    assert errors[1][0] < 0.1 * errors[0][0] and errors[1][1] < 0.25 * errors[0][1], errors


def test_bad_input_is_named():
    FILES.run("source", "--shape", "cube", "--output", "cube.vtu", "--force")
    FILES.run("source", "--output", "square.vtu", "--force")
    for words, part in ((("cube.vtu", "square.vtu"), "square.vtu"), (("cube.vtu", "cube.vtu", "--reference", "square.vtu"), "bounds no solid")):
        done = FILES.run("compare", *words, "--output", "no.csv", status=1)
        assert part in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr
        assert not os.path.exists(FILES.path("no.csv"))


knotwork_testing.main(globals())
