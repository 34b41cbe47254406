# SPDX-License-Identifier: BSD-3-Clause
"""Files of Gmsh itself, where it is installed: verdicts against its bounds of the Jacobian determinant, folded elements by their numbers, and
what we write of these files in Gmsh again."""
import json
import os

import knotwork
import knotwork_testing
import numpy as np

try:
    import gmsh
except ImportError:
    knotwork_testing.skip("Gmsh's module for Python is not installed")


def path(name):
    return knotwork_testing.output("gmsh_meshes/" + name)


def validated(file):
    done = knotwork_testing.run_program("validate", file, "--report", path("report.json"))
    assert done.returncode in (0, 3), (file, done.stderr)
    with open(path("report.json")) as stream:
        return json.load(stream)


def meshed(shape, order, incomplete):
    """A mesh of Gmsh; the dimension of its elements."""
    gmsh.clear()
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", int(incomplete))
    occ = gmsh.model.occ
    size = 0.8 if shape == "ball" else 0.4
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    dimension = 2 if shape in ("disc", "quadrilaterals") else 3
    if shape == "ball":
        occ.addSphere(0, 0, 0, 1)
    elif shape == "disc":
        occ.addDisk(0, 0, 0, 1, 1)
    else:
        occ.addRectangle(0, 0, 0, 1, 1)
    if shape in ("hexahedra", "wedges"):
        occ.extrude([(2, 1)], 0, 0, 1, [3], recombine=True)
    occ.synchronize()
    if shape in ("hexahedra", "quadrilaterals"):
        for _, curve in gmsh.model.getEntities(1):
            gmsh.model.mesh.setTransfiniteCurve(curve, 4)
        gmsh.model.mesh.setTransfiniteSurface(1)
        gmsh.model.mesh.setRecombine(2, 1)
    gmsh.model.addPhysicalGroup(dimension, [1], 7)
    gmsh.model.setPhysicalName(dimension, 7, "the part")
    gmsh.model.mesh.generate(dimension)
    gmsh.model.mesh.setOrder(order)
    return dimension


def fold(dimension, random):
    """Moves some nodes inside."""
    tags, places, _ = gmsh.model.mesh.getNodes(dimension, 1)
    for k in random.choice(len(tags), min(2, len(tags)), replace=False):
        step = random.normal(size=3)
        step[dimension:] = 0
        gmsh.model.mesh.setNode(int(tags[k]), list(np.array(places[3 * k:3 * k + 3]) + 0.5 * step / np.linalg.norm(step)), [])


def least_jacobians(dimension):
    """Of every element the quotient of the smallest and largest Jacobian determinant, by Gmsh's own bounds."""
    for name, value in (("JacobianDeterminant", 1), ("CreateView", 1), ("Recompute", 1), ("DimensionOfElements", dimension)):
        gmsh.plugin.setNumber("AnalyseMeshQuality", name, value)
    gmsh.plugin.run("AnalyseMeshQuality")
    _, tags, values, _, _ = gmsh.view.getModelData(gmsh.view.getTags()[0], 0)
    return {int(tag): value[0] for tag, value in zip(tags, values)}


def test_verdicts_agree_with_gmsh():
    random = np.random.default_rng(7)
    gmsh.initialize(readConfigFiles=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        cases = [(shape, order) for shape in ("ball", "disc", "hexahedra", "quadrilaterals") for order in (1, 2, 3, 4)]
        cases += [("wedges", 1), ("wedges", 2), ("disc", 5), ("ball", 5)]
        folded = 0
        for number, (shape, order) in enumerate(cases):
            dimension = meshed(shape, order, incomplete=number == 17)  # Gmsh has no bounds for hexahedra of 20 nodes
            if number % 2 == 1:
                fold(dimension, random)
            least = least_jacobians(dimension)
            gmsh.option.setNumber("Mesh.MshFileVersion", 2.2 if number % 3 == 0 else 4.1)
            gmsh.option.setNumber("Mesh.Binary", number // 2 % 2)
            gmsh.write(path("gmsh.msh"))
            report = validated(path("gmsh.msh"))
            expected = sorted(tag for tag, value in least.items() if value < -1e-6)
            assert sorted(report["folded_elements"])[:100] == expected[:100] and report["undecided_cells"] == 0, (shape, order, report, expected)
            folded += len(expected)
            opened_again(path("gmsh.msh"), dimension, least)
        assert folded > 10, folded
    finally:
        gmsh.finalize()


def opened_again(file, dimension, least):
    """What we write of a file opens in Gmsh with the same elements, groups, and bounds."""
    knotwork.write(knotwork.read(file), path("ours.msh"), encoding="ascii" if dimension == 2 else "binary")
    gmsh.clear()
    gmsh.open(path("ours.msh"))
    groups = gmsh.model.getPhysicalGroups(dimension)
    assert groups == [(dimension, 7)] and gmsh.model.getPhysicalName(dimension, 7) == "the part", groups
    again = least_jacobians(dimension)
    assert again.keys() == least.keys() and all(abs(again[tag] - least[tag]) < 1e-6 * (1 + abs(least[tag])) for tag in least)


os.makedirs(path(""), exist_ok=True)
knotwork_testing.main(globals())
