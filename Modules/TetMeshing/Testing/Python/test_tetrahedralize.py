# SPDX-License-Identifier: BSD-3-Clause
"""From files to files: boundaries of splines, meshes of libcgal-demo that TetGen alone refuses, what is said of bad ones."""
import json
import os
import tarfile

import knotwork_testing

FOLDER = os.path.dirname(knotwork_testing.output("tetrahedralize/files"))
ARCHIVE = "/usr/share/doc/libcgal-dev/data.tar.gz"


def run(*words, status=0):
    done = knotwork_testing.run_program(*words, folder=FOLDER)
    assert done.returncode == status, (words, done.stderr)
    return done


def report(*words):
    run(*words, "--report", "report.json", "--force")
    with open(os.path.join(FOLDER, "report.json"), encoding="utf-8") as file:
        return json.load(file)


def unpack(name):
    if not os.path.exists(ARCHIVE):
        knotwork_testing.skip(f"{ARCHIVE} is missing; install the package libcgal-demo")
    with tarfile.open(ARCHIVE) as archive, open(os.path.join(FOLDER, name), "wb") as file:
        file.write(archive.extractfile(f"data/meshes/{name}").read())


def test_a_spline_and_its_boundary():
    run("source", "--shape", "solid-cylinder", "--output", "rod.vtu", "--force")
    boundary = report("boundary", "rod.vtu", "--chordal-tolerance", "0.005", "--output", "rod.vtp")
    assert boundary["closed"] and boundary["volume"] < 3.1416, boundary
    straight = report("tetrahedralize", "rod.vtp", "--output", "straight.vtu")
    assert abs(straight["volume"] - boundary["volume"]) < 1e-9 and straight["verdict"] == "valid", straight
    curved = report("tetrahedralize", "rod.vtp", "--target", "rod.vtu", "--order", "2", "--output", "curved.vtu")
    assert curved["curved_to_target"] < 0.1 * curved["straight_to_target"], curved
    assert abs(curved["volume"] - 3.14159265) < 1e-3 and curved["verdict"] == "valid", curved
    run("validate", "curved.vtu")


def test_intersections_are_named_and_repaired():
    unpack("bull.off")
    done = run("tetrahedralize", "bull.off", "--output", "no.vtu", status=1)
    assert "turned" in done.stderr or "intersect" in done.stderr, done.stderr
    assert "repair" in done.stderr and not os.path.exists(os.path.join(FOLDER, "no.vtu")), done.stderr
    found = report("tetrahedralize", "bull.off", "--repair", "--output", "bull.vtu")
    assert found["repaired"] and found["verdict"] == "valid", found
    assert max(found["distance_to_surface"], found["distance_from_surface"]) <= 1e-3 * found["diagonal"], found


knotwork_testing.main(globals())
