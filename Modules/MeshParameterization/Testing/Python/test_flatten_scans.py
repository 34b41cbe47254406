# SPDX-License-Identifier: BSD-3-Clause
"""What the page claims of HLLE on meshes from files, where the environment variable KNOTWORK_MESH_CASES names their folder."""
import importlib.util
import os
import pathlib
import sys
import tempfile

import knotwork_testing

MESHES = pathlib.Path(os.environ.get("KNOTWORK_MESH_CASES", ""))
if not (MESHES / "scone_2k.off").exists():
    print("skipped: KNOTWORK_MESH_CASES names no folder with scone_2k.off")
    sys.exit(0)

SCRIPT = pathlib.Path(__file__).resolve().parents[4] / "Testing/Benchmarks/flatten.py"
SPEC = importlib.util.spec_from_file_location("flatten", SCRIPT)
tables = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(tables)


def flatten(name, *options):
    with tempfile.TemporaryDirectory() as folder:
        return tables.flatten(knotwork_testing.PROGRAM, MESHES / f"{name}.off", folder, *options)


def near_truth(name, bar):
    said = flatten(name, "hlle", "--fallback", "0")
    assert said["flipped_triangles"] == 0, said["flipped_triangles"]
    rms = tables.distance_from_truth(said["uv"], tables.truth_of(MESHES / f"{name}.off"))
    assert rms <= bar, rms


def test_s_on_a_cone_is_flat_exact_oracle():
    near_truth("scone_2k", 4e-4)
    near_truth("scone_10k", 4e-4)


def test_swiss_roll_with_a_hole_is_flat_exact_oracle():
    near_truth("swisshole_3k", 1e-3)


def test_tight_roll_is_flat_exact_oracle():
    near_truth("tightroll_6k", 2e-3)


def test_faces_and_beetle_do_not_flip_property_oracle():
    for name in ("maskgen_3k", "beetle"):
        said = flatten(name, "hlle", "--fallback", "0")
        assert said["method"] == "hlle" and said["flipped_triangles"] == 0


def test_half_glove_falls_back_and_says_so_property_oracle():
    alone = flatten("half_glove_a", "hlle", "--fallback", "0")
    assert alone["flipped_triangles"] < 24 and not alone["fallback"]
    said = flatten("half_glove_a", "hlle")
    assert said["flipped_triangles"] == 0
    assert said["fallback"] == (said["method"] != "hlle")
    assert said["fallback_reason"] or alone["flipped_triangles"] == 0


def test_isomap_folds_the_s_property_oracle():
    said = flatten("scone_2k", "isomap")
    assert said["flipped_triangles"] > 0.3 * said["triangles"]


def test_the_distance_from_the_truth_sees_errors_exact_oracle():
    truth = tables.truth_of(MESHES / "scone_2k.off")
    turned = truth @ [[0.6, 0.8], [-0.8, 0.6]] + [3.0, -5.0]
    assert tables.distance_from_truth(turned, truth) < 1e-12
    assert tables.distance_from_truth(1.001 * turned, truth) > 1e-4


knotwork_testing.main(globals())
