# SPDX-License-Identifier: BSD-3-Clause
"""Parts of gmsh-doc, from files to files: all quadrilaterals, closed, with the Euler number of the part, none inverted; and what
`cadfit` makes of them."""
import gzip
import json
import math
import os

import knotwork_testing
from quad_checks import check_solids, meshed

FOLDER = os.path.dirname(knotwork_testing.output("cad_quads/files"))
DEMOS = "/usr/share/doc/gmsh-doc/doc/gmsh/demos/boolean"
# 2 - 2 genus, summed over the solids
EULER = {"component8.step": 0, "as1-tu-203.stp": -8}


def unpack(name):
    source = os.path.join(DEMOS, name + ".gz")
    if not os.path.exists(source):
        knotwork_testing.skip(f"{source} is missing; install the package gmsh-doc")
    with gzip.open(source) as packed, open(os.path.join(FOLDER, name), "wb") as file:
        file.write(packed.read())
    return os.path.join(FOLDER, name)


def test_parts_of_gmsh():
    for name in ("component8.step", "as1-tu-203.stp"):
        check_solids(*meshed(FOLDER, unpack(name)), EULER[name])


def test_a_face_without_a_grid_is_named():
    part = unpack("component8.step")
    done = knotwork_testing.run_program("quads", part, "--method", "mapped", "--output", "no.vtp", folder=FOLDER)
    assert done.returncode == 1 and "is not mapped" in done.stderr and not os.path.exists(os.path.join(FOLDER, "no.vtp")), done.stderr


def run(job, *words):
    done = knotwork_testing.run_program(job, *map(str, words), "--force", "--report", job + ".json", folder=FOLDER, timeout=600)
    assert done.returncode == 0, (job, words, done.stderr)
    with open(os.path.join(FOLDER, job + ".json"), encoding="utf-8") as file:
        return json.load(file)


def fitted(mesh, part):
    """The report of the fit, and what OpenCASCADE finds in its STEP file."""
    report = run("cadfit", mesh, "--target", part, "--degree", 2, "--output", "fit.vtu")
    run("convert", "fit.vtu", "--output", "fit.step")
    return report, run("cadmodify", "fit.step", "--suggest")["part"]


def test_solids_that_share_a_face_are_solids_of_their_own():
    part = run("cadmodify", knotwork_testing.data(os.path.join("Parts", "cylinder_on_cube.step")), "--imprint", "--output", "shared.step")
    assert part["solids"] == 2
    run("quads", "shared.step", "--output", "shared.vtp")
    done = knotwork_testing.run_program("cadfit", "shared.vtp", "--target", "shared.step", "--output", "no.vtu", folder=FOLDER)
    assert done.returncode == 1 and "have one edge in common" in done.stderr and "points of their own" in done.stderr, done.stderr
    quads = run("quads", "shared.step", "--solids-apart", "--output", "apart.vtp")
    assert quads["closed"] and quads["solids_apart"] and quads["euler_number"] == 4, quads
    report, solids = fitted("apart.vtp", "shared.step")
    assert report["verdict"] == "valid" and solids["solids"] == 2, (report, solids)
    volume = 20 ** 3 + math.pi * 6 ** 2 * 12
    assert abs(solids["volume"] - volume) < 1e-4 * volume, (solids, volume)


def test_the_mesh_is_fitted_to_the_part():
    part = unpack("component8.step")
    own = run("cadmodify", part, "--suggest")["part"]["volume"]
    meshed(FOLDER, part)
    report, solid = fitted("quads.vtp", part)
    # three elements have tips with an angle of zero, where no map is regular
    assert report["unmatched_features"] == 0 and report["uncertified_elements"] <= 3, report
    assert solid["solids"] == 1 and abs(solid["volume"] - own) < 1e-3 * own, (solid, own)


def test_an_assembly_is_fitted_at_once():
    """Its 18 solids touch each other along edges and in parts of faces: each has its own edges."""
    part = unpack("as1-tu-203.stp")
    own = run("cadmodify", part, "--suggest")["part"]["volume"]
    meshed(FOLDER, part)
    run("hexes", part, "--output", "hexes.vtu")
    for mesh in ("quads.vtp", "hexes.vtu"):
        report, solid = fitted(mesh, part)
        assert report["verdict"] == "valid" and report["uncertified_elements"] == 0 and report["unmatched_features"] == 0, (mesh, report)
        assert report["max_distance"] < 0.05, report["max_distance"]  # of a diagonal of 240 mm
        assert solid["solids"] == 18 and abs(solid["volume"] - own) < 1e-3 * own, (mesh, solid, own)


knotwork_testing.main(globals())
