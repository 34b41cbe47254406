# SPDX-License-Identifier: BSD-3-Clause
"""What stands on the package's page runs, one block after the other, on files as they are named there."""
import os
import re
import tempfile

import knotwork as kw
import knotwork_testing
import numpy as np

PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "README.md")


def make_files():
    kw.boundary(kw.source("cube", center=(0.5, 0.5, 0.5))).save("scan.stl")
    rng = np.random.default_rng(1)
    xy = rng.random((2000, 2))
    np.savetxt("points.xyz", np.column_stack([xy, 10 * np.sin(4 * xy[:, 0]) * np.cos(3 * xy[:, 1])]), fmt="%.17g")
    box = [[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)]
    kw.spline([[0, 0, 1, 1]] * 3, np.reshape(box, (2, 2, 2, 3)) * [2, 1, 1]).save("map.vtu")
    with open("mesh.msh", "w", encoding="ascii") as stream:
        stream.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0.2 0.2 0\n$EndNodes\n"
                     "$Elements\n1\n1 3 2 0 1 1 2 5 4\n$EndElements\n")


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
