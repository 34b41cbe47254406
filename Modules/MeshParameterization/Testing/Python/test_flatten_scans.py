# SPDX-License-Identifier: BSD-3-Clause
"""usage: test_flatten_scans.py generated|files

What the page claims of HLLE: on meshes from formulas, or on those of the folder that the environment variable
KNOTWORK_MESH_CASES names."""
import importlib.util
import os
import pathlib
import sys
import tempfile

import generated_meshes
import knotwork_testing

SCRIPT = pathlib.Path(__file__).resolve().parents[4] / "Testing/Benchmarks/flatten.py"
sys.path.insert(0, str(SCRIPT.parent))
SPEC = importlib.util.spec_from_file_location("flatten", SCRIPT)
tables = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(tables)

if sys.argv[1] == "generated":
    MESHES = pathlib.Path(knotwork_testing.output("flatten_scans/x")).parent
    generated_meshes.s_on_cone(MESHES / "s_on_cone.off")
    generated_meshes.roll_with_hole(MESHES / "roll_with_hole.off")
    generated_meshes.mask(MESHES / "mask.off")
    LETTER = "s_on_cone"
    DEVELOPABLE = {"s_on_cone": 1e-4, "roll_with_hole": 5e-4}
    REGULAR = ["mask"]
else:
    MESHES = pathlib.Path(os.environ.get("KNOTWORK_MESH_CASES", ""))
    if not (MESHES / "scone_2k.off").exists():
        knotwork_testing.skip("KNOTWORK_MESH_CASES names no folder with scone_2k.off")
    LETTER = "scone_2k"
    DEVELOPABLE = {"scone_2k": 4e-4, "scone_10k": 4e-4, "swisshole_3k": 1e-3, "tightroll_6k": 2e-3}
    REGULAR = ["maskgen_3k", "beetle"]


def flatten(name, *options):
    with tempfile.TemporaryDirectory() as folder:
        return tables.flatten(knotwork_testing.PROGRAM, MESHES / f"{name}.off", folder, *options)


def test_developable_surfaces_are_flat_exact_oracle():
    for name, bar in DEVELOPABLE.items():
        said = flatten(name, "hlle", "--fallback", "0")
        assert said["flipped_triangles"] == 0, (name, said["flipped_triangles"])
        rms = tables.distance_from_truth(said["uv"], tables.truth_of(MESHES / f"{name}.off"))
        print(name, len(said["uv"]), rms)
        assert rms <= bar, (name, rms)


def test_others_do_not_flip_property_oracle():
    for name in REGULAR:
        said = flatten(name, "hlle", "--fallback", "0")
        assert said["method"] == "hlle" and said["flipped_triangles"] == 0, name


def test_isomap_folds_the_s_property_oracle():
    said = flatten(LETTER, "isomap")
    assert said["flipped_triangles"] > 0.3 * said["triangles"]


def test_the_distance_from_the_truth_sees_errors_exact_oracle():
    truth = tables.truth_of(MESHES / f"{LETTER}.off")
    turned = truth @ [[0.6, 0.8], [-0.8, 0.6]] + [3.0, -5.0]
    assert tables.distance_from_truth(turned, truth) < 1e-12
    assert tables.distance_from_truth(1.001 * turned, truth) > 1e-4


if sys.argv[1] == "files":
    def test_half_glove_falls_back_and_says_so_property_oracle():
        alone = flatten("half_glove_a", "hlle", "--fallback", "0")
        assert alone["flipped_triangles"] < 24 and not alone["fallback"]
        said = flatten("half_glove_a", "hlle")
        assert said["flipped_triangles"] == 0
        assert said["fallback"] == (said["method"] != "hlle")
        assert said["fallback_reason"] or alone["flipped_triangles"] == 0


knotwork_testing.main(globals())
