# SPDX-License-Identifier: BSD-3-Clause
"""From files to files: boundaries of splines, meshes of libcgal-demo that TetGen alone refuses, what is said of bad ones."""
import os

import knotwork_testing

FILES = knotwork_testing.Files("tetrahedralize")


def test_a_spline_and_its_boundary():
    FILES.run("source", "--shape", "solid-cylinder", "--output", "rod.vtu", "--force")
    boundary = FILES.report("boundary", "rod.vtu", "--chordal-tolerance", "0.005", "--output", "rod.vtp")
    assert boundary["closed"] and boundary["volume"] < 3.1416, boundary
    straight = FILES.report("tetrahedralize", "rod.vtp", "--output", "straight.vtu")
    assert abs(straight["volume"] - boundary["volume"]) < 1e-9 and straight["verdict"] == "valid", straight
    curved = FILES.report("tetrahedralize", "rod.vtp", "--target", "rod.vtu", "--order", "2", "--output", "curved.vtu")
    assert curved["curved_to_target"] < 0.1 * curved["straight_to_target"], curved
    assert abs(curved["volume"] - 3.14159265) < 1e-3 and curved["verdict"] == "valid", curved
    FILES.run("validate", "curved.vtu")


def test_no_cell_lies_flat_on_a_smooth_boundary():
    """TetGen leaves cells with two faces on the tube, which would have to be moved back from it."""
    FILES.run("source", "--shape", "solid-torus", "--inner-radius", "0.3", "--angle", "270", "--output", "torus.vtu", "--force")
    FILES.run("boundary", "torus.vtu", "--chordal-tolerance", "0.01", "--output", "torus.vtp", "--force")
    FILES.run("remesh", "torus.vtp", "--size", "0.2", "--output", "even.vtp", "--force")
    for order in (2, 3):
        found = FILES.report("tetrahedralize", "even.vtp", "--target", "torus.vtu", "--order", order, "--edge-length", "0.2", "--output", "torus_tets.vtu")
        assert found["verdict"] == "valid" and found["relaxed_elements"] == 0, found
        assert found["curved_to_target"] < 0.05 * found["straight_to_target"], found


def test_intersections_are_named_and_repaired():
    FILES.unpack_meshes("bull")
    done = FILES.run("tetrahedralize", "bull.off", "--output", "no.vtu", status=1)
    assert "turned" in done.stderr or "intersect" in done.stderr, done.stderr
    assert "repair" in done.stderr and not os.path.exists(FILES.path("no.vtu")), done.stderr
    found = FILES.report("tetrahedralize", "bull.off", "--repair", "--output", "bull.vtu")
    assert found["repaired"] and found["verdict"] == "valid", found
    assert max(found["distance_to_surface"], found["distance_from_surface"]) <= 1e-3 * found["diagonal"], found


knotwork_testing.main(globals())
