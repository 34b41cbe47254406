# SPDX-License-Identifier: BSD-3-Clause
"""What stands on the package's page runs, one block after the other, on files as they are named there."""
import os
import re
import tempfile

import knotwork as kw
import knotwork_testing
import numpy as np
from page_files import make_files

PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "README.md")


def test_the_page_runs():
    with open(PAGE, encoding="utf-8") as stream:
        blocks = re.findall(r"```python\n(.*?)```", stream.read(), re.S)
    assert len(blocks) == 3
    names = {}
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            make_files()
            for block in blocks:
                exec(compile(block, "README.md", "exec"), names)
            for file in ("scan.step", "contours.vtp", "bent.stl", "surface.vtu", "surface.png"):
                assert os.path.getsize(file) > 100, file
        finally:
            os.chdir(before)
    assert np.allclose(names["s"](0.5, 0.25), [1, 0.25, 0.5], rtol=0, atol=1e-15)
    assert names["folded"].tolist() == [0]
    assert kw.validate(names["plate"]).numbers["verdict"] == "valid"
    assert names["surface"].numbers["points_outside"] == 0


knotwork_testing.main(globals())
