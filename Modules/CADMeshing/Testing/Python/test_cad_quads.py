# SPDX-License-Identifier: BSD-3-Clause
"""Parts of gmsh-doc, from files to files: all quadrilaterals, closed, with the Euler number of the part, none inverted; and what
`cadfit` makes of them."""
import gzip
import os

import knotwork_testing
from quad_checks import check_solids, meshed

FOLDER = os.path.dirname(knotwork_testing.output("cad_quads/files"))
DEMOS = "/usr/share/doc/gmsh-doc/doc/gmsh/demos/boolean"
# 2 - 2 genus, summed over the solids
EULER = {"component8.step": 0, "as1-tu-203.stp": -20}


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


def test_the_mesh_is_fitted_to_the_part():
    part = unpack("component8.step")
    meshed(FOLDER, part)
    done = knotwork_testing.run_program("cadfit", "quads.vtp", "--target", part, "--degree", "2", "--output", "fit.vtu", "--report", "fit.json",
                                        "--force", folder=FOLDER, timeout=600)
    assert done.returncode == 0, done.stderr


knotwork_testing.main(globals())
