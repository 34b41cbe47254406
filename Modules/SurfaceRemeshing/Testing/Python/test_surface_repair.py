# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of libcgal-demo whose triangles meet, from files to files: what the job says, and that the result needs no second repair."""
import json
import os

import knotwork_testing

FILES = knotwork_testing.Files("repair")
NAMES = ("bones", "bull", "camel", "cow", "diplodocus", "elk", "man")
BOUND = 1e-3  # of the diagonal, both ways


def repaired(name, *options):
    return FILES.report("repair", name, *options, "--output", "repaired.vtp", "--actions", "actions.vtp")


def test_meshes_that_meet_themselves():
    FILES.unpack_meshes(*NAMES)
    for name in NAMES:
        report = repaired(name + ".off")
        assert report["changed"] and report["closed"] and report["intersections"] > 0, report
        assert max(report["distance_from_input"], report["distance_to_input"]) <= BOUND * report["diagonal"], report
        os.replace(FILES.path("repaired.vtp"), FILES.path("first.vtp"))
        again = repaired("first.vtp")
        assert not again["changed"] and again["euler_after"] == report["euler_after"], (name, again)


def test_sound_meshes_stay():
    FILES.unpack_meshes("elephant", "rotor")
    for name in ("elephant", "rotor"):
        report = repaired(name + ".off")
        assert not report["changed"] and report["distance_to_input"] == 0, report


def test_a_hole_is_an_error_or_closed():
    FILES.unpack_meshes("double-torus-3-holes")
    done = FILES.run("repair", "double-torus-3-holes.off", "--output", "no.vtp", status=1)
    assert "3 holes stay, at (" in done.stderr and "LargestHole" in done.stderr, done.stderr
    report = repaired("double-torus-3-holes.off", "--largest-hole", "0.5")
    assert report["closed"] and report["holes"] == 3 and report["euler_after"] == -2, report
    assert not repaired("double-torus-3-holes.off", "--allow-open")["closed"]


def test_a_wrap_is_made_on_request_alone():
    FILES.unpack_meshes("double-torus-3-holes")
    FILES.run("repair", "double-torus-3-holes.off", "--output", "no.vtp", status=1)
    done = FILES.run("repair", "double-torus-3-holes.off", "--alpha-wrap", "--wrap-alpha", "0.05", "--output", "wrap.vtp", "--report", "wrap.json", "--force")
    assert "alpha wrap" in done.stderr and "3 holes stay" in done.stderr, done.stderr
    with open(FILES.path("wrap.json"), encoding="utf-8") as file:
        report = json.load(file)
    assert report["wrapped"] and report["closed"] and report["distance_from_input"] > 0, report
    assert not repaired("double-torus-3-holes.off", "--alpha-wrap", "--largest-hole", "0.5")["wrapped"]


knotwork_testing.main(globals())
