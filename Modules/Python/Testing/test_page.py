# SPDX-License-Identifier: BSD-3-Clause
"""What stands on the package's page runs, one block after the other, on files as they are named there."""
import os
import tempfile

import knotwork as kw
import knotwork_testing
import numpy as np
import page_snippets
from page_files import make_files

PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "README.md")


def test_the_page_runs():
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            make_files()
        finally:
            os.chdir(before)
        names, count = page_snippets.run_page(PAGE, folder)
        assert count == 3
        for file in ("scan.step", "contours.vtp", "bent.stl", "surface.vtu", "surface.png"):
            assert os.path.getsize(os.path.join(folder, file)) > 100, file
    assert np.allclose(names["s"](0.5, 0.25), [1, 0.25, 0.5], rtol=0, atol=1e-15)
    assert names["folded"].tolist() == [0]
    assert kw.validate(names["plate"]).numbers["verdict"] == "valid"
    assert names["surface"].numbers["points_outside"] == 0


knotwork_testing.main(globals())
