# SPDX-License-Identifier: BSD-3-Clause
"""The files that the package's page names."""
import knotwork as kw
import numpy as np


def make_files():
    """scan.stl, points.xyz, map.vtu and mesh.msh in the present folder."""
    kw.boundary(kw.source("cube", center=(0.5, 0.5, 0.5))).save("scan.stl")
    rng = np.random.default_rng(1)
    xy = rng.random((2000, 2))
    np.savetxt("points.xyz", np.column_stack([xy, 10 * np.sin(4 * xy[:, 0]) * np.cos(3 * xy[:, 1])]), fmt="%.17g")
    box = [[x, y, z] for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)]
    kw.spline([[0, 0, 1, 1]] * 3, np.reshape(box, (2, 2, 2, 3)) * [2, 1, 1]).save("map.vtu")
    with open("mesh.msh", "w", encoding="ascii") as stream:
        stream.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0.2 0.2 0\n$EndNodes\n"
                     "$Elements\n1\n1 3 2 0 1 1 2 5 4\n$EndElements\n")
