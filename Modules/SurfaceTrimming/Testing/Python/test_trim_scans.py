# SPDX-License-Identifier: BSD-3-Clause
"""usage: test_trim_scans.py generated|files

Whole runs to STEP on meshes from formulas, or on scans of the folder that the environment variable KNOTWORK_MESH_CASES names:
within a thousandth of the diagonal, proved, every hole there, valid when it is read again."""
import json
import os
import pathlib
import sys

import generated_meshes
import knotwork_testing

if sys.argv[1] == "generated":
    MESHES = pathlib.Path(knotwork_testing.output("trim_scans_generated/x")).parent
    generated_meshes.s_on_cone(MESHES / "s_on_cone.off")
    generated_meshes.roll_with_hole(MESHES / "roll_with_hole.off")
    generated_meshes.mask(MESHES / "mask.off")
    ONE_FACE = {"s_on_cone.off": 1, "roll_with_hole.off": 2, "mask.off": 4}  # loops
else:
    MESHES = pathlib.Path(os.environ.get("KNOTWORK_MESH_CASES", ""))
    if not (MESHES / "beetle.off").exists():
        knotwork_testing.skip("KNOTWORK_MESH_CASES names no folder with beetle.off")
    ONE_FACE = {"scone_2k.off": 1, "beetle.off": 11, "maskgen_3k.off": 4}


def trim(name, loops):
    """The report of a run with what every scan must fulfil checked."""
    report = knotwork_testing.output(f"trim_scans_{sys.argv[1]}/report.json")
    face = knotwork_testing.output(f"trim_scans_{sys.argv[1]}/face.step")
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


def test_one_regular_face_property_oracle():
    for name, loops in ONE_FACE.items():
        said = trim(name, loops)
        assert said["faces"] == 1 and said["verdict"] == "valid" and said["min_normal_bound"] > 0, name


if sys.argv[1] == "files":
    def test_airplane_in_several_faces_property_oracle():
        said = trim("plane_27holes.obj", 27)
        assert said["faces"] > 1


knotwork_testing.main(globals())
