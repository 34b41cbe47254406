# SPDX-License-Identifier: BSD-3-Clause
"""Solids of the folder that KNOTWORK_UNSTRUCTURED_MESHES names, as test_cad_quads.py those of gmsh-doc."""
import glob
import os

import knotwork_testing
from quad_checks import check_solids, meshed

FOLDER = os.path.dirname(knotwork_testing.output("hexme_solids/files"))
# 2 - 2 genus; of others 2
EULER = {"hexme_i01o_m1.step": -16, "hexme_s16o_torus.stp": 0}


def test_solids_of_the_folder():
    folder = os.environ.get("KNOTWORK_UNSTRUCTURED_MESHES", "")
    parts = sorted(glob.glob(os.path.join(folder, "hexme_*.st*p"))) if folder else []
    if not parts:
        knotwork_testing.skip("KNOTWORK_UNSTRUCTURED_MESHES names no folder with hexme_*.step")
    for part in parts:
        check_solids(*meshed(FOLDER, part), EULER.get(os.path.basename(part), 2))


knotwork_testing.main(globals())
