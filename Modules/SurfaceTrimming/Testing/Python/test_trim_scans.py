# SPDX-License-Identifier: BSD-3-Clause
"""Whole runs to STEP on scans from files, where the environment variable KNOTWORK_MESH_CASES names their folder: within a
thousandth of the diagonal, proved, every hole there, valid when it is read again."""
import json
import os
import pathlib
import sys

import knotwork_testing

MESHES = pathlib.Path(os.environ.get("KNOTWORK_MESH_CASES", ""))
if not (MESHES / "beetle.off").exists():
    print("skipped: KNOTWORK_MESH_CASES names no folder with beetle.off")
    sys.exit(0)


def trim(name, loops):
    """The report of a run with what every scan must fulfil checked."""
    report = knotwork_testing.output("trim_scans/report.json")
    face = knotwork_testing.output("trim_scans/face.step")
    done = knotwork_testing.run_program("trim", str(MESHES / name), "--output", face, "--report", report)
    assert done.returncode == 0, done.stderr
    with open(report) as stream:
        said = json.load(stream)
    assert said["brep_valid"]
    assert said["within_tolerance"] and said["max_deviation"] <= said["tolerance"]
    assert said["loops_proved"] and said["loops"] == loops and said["file_loops"] == loops, said["file_loops"]
    assert said["file_faces"] == said["faces"]
    assert max(said["max_edge_tolerance"], said["max_vertex_tolerance"]) <= said["tolerance"]
    assert abs(said["area"] / said["mesh_area"] - 1) < 5e-3
    assert abs(said["file_area"] / said["mesh_area"] - 1) < 5e-3
    return said


def one_regular_face(name, loops):
    said = trim(name, loops)
    assert said["faces"] == 1 and said["verdict"] == "valid" and said["min_normal_bound"] > 0


def test_s_on_a_cone_property_oracle():
    one_regular_face("scone_2k.off", 1)


def test_beetle_with_its_windows_property_oracle():
    one_regular_face("beetle.off", 11)


def test_face_with_eyes_and_mouth_property_oracle():
    one_regular_face("maskgen_3k.off", 4)


def test_airplane_in_several_faces_property_oracle():
    said = trim("plane_27holes.obj", 27)
    assert said["faces"] > 1


knotwork_testing.main(globals())
