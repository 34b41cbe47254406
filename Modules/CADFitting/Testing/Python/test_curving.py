# SPDX-License-Identifier: BSD-3-Clause
"""Elements of higher order on shapes, from files to files: volumes and areas are known, tetrahedra are those that `tetrahedralize` curves
itself, solvers' meshes come back in Gmsh where it is installed, and bad inputs are told in one line."""
import math
import os

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

try:
    import gmsh
except ImportError:
    gmsh = None

FILES = knotwork_testing.Files("curving", timeout=600)


def curved(mesh, target, order, *words, output="curved.vtu"):
    found = FILES.report("cadfit", mesh, "--target", target, "--elements-only", "--order", order, "--output", output, *words)
    assert found["certified_elements"] == found["elements"] and found["verdict"] == "valid", found
    return found


def write_disc(name, n, radius=1.0):
    """Quadrilaterals of a disc: a square and four sides."""
    numbers, points, quads = {}, [], []

    def number(x, y):
        key = (round(x * 1e9), round(y * 1e9))
        if key not in numbers:
            numbers[key] = len(points)
            points.append((x, y))
        return numbers[key]

    def block(place):
        for i, j in np.ndindex(n, n):
            quads.append([number(*place(a / n, b / n)) for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))])

    def inner(u, v):
        return 0.5 * math.tan((2 * u - 1) * math.pi / 4), 0.5 * math.tan((2 * v - 1) * math.pi / 4)

    block(inner)
    for side in range(4):
        c, s = round(math.cos(side * math.pi / 2)), round(math.sin(side * math.pi / 2))

        def outer(u, v):
            angle = (2 * v - 1) * math.pi / 4
            x, y = (1 - u) * 0.5 + u * math.cos(angle), (1 - u) * 0.5 * math.tan(angle) + u * math.sin(angle)
            return c * x - s * y, s * x + c * y

        block(outer)
    with open(FILES.path(name), "w", encoding="utf-8") as file:
        file.write(f"OFF\n{len(points)} {len(quads)} 0\n")
        file.writelines("%.17g %.17g 0\n" % (radius * x, radius * y) for x, y in points)
        file.writelines("4 %d %d %d %d\n" % tuple(quad) for quad in quads)
    return name


def part(name, make):
    """A CAD part of Gmsh's kernel."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 0)
    make(gmsh.model.occ)
    gmsh.model.occ.synchronize()
    gmsh.write(FILES.path(name))
    gmsh.finalize()
    return name


def rates(errors):
    return [math.log2(abs(a / b)) for a, b in zip(errors, errors[1:])]


def test_tetrahedra_are_those_of_tetrahedralize():
    """One kernel: a straight mesh that is curved later is the curved one, to the bit. CrossOracle."""
    FILES.run("source", "--shape", "ball", "--output", "ball.vtu", "--force")
    for order in (2, 3):
        whole = FILES.report("tetrahedralize", "ball.vtu", "--chordal-tolerance", 0.02, "--order", order, "--output", "whole.vtu")
        FILES.run("tetrahedralize", "ball.vtu", "--chordal-tolerance", 0.02, "--output", "straight.vtu", "--force", "--quiet")
        later = curved("straight.vtu", "ball.vtu", order)
        points = [vtk_to_numpy(knotwork.read(FILES.path(name)).GetPoints().GetData()) for name in ("whole.vtu", "curved.vtu")]
        assert points[0].shape == points[1].shape and np.abs(points[0] - points[1]).max() == 0.0
        assert later["volume"] == whole["volume"] and later["relaxed_elements"] == whole["relaxed_elements"], (later, whole)


def test_tetrahedra_reach_the_order():
    """Volume of the unit ball and distances from it, edges half as long each time. ConvergenceOracle."""
    FILES.run("source", "--shape", "ball", "--output", "ball.vtu", "--force")
    for order in (2, 3, 4):
        errors, distances = [], []
        for tolerance in (0.02, 0.005, 0.00125):
            FILES.run("tetrahedralize", "ball.vtu", "--chordal-tolerance", tolerance, "--output", "straight.vtu", "--force", "--quiet")
            found = curved("straight.vtu", "ball.vtu", order)
            errors.append(found["volume"] - 4 / 3 * math.pi)
            distances.append(found["rms_distance"])
        assert math.log2(abs(errors[0] / errors[2])) / 2 > order + 0.6, (order, errors)
        assert math.log2(distances[0] / distances[2]) / 2 > order + 0.6, (order, distances)


def test_hexahedra_of_sweep():
    """A cylinder of CAD: its rims are circles, its volume and area are told beside OpenCASCADE's. ConvergenceOracle."""
    if gmsh is None:
        knotwork_testing.skip("Gmsh's module for Python is not installed")
    part("rod.step", lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 2, 1))
    for order in (2, 3, 4):
        errors, areas = [], []
        for n in (1, 2, 4):
            FILES.run("sweep", write_disc("disc.off", n), "--direction", 0, 0, 2, "--layers", 2 * n, "--output", "rod.vtu", "--force")
            found = curved("rod.vtu", "rod.step", order)
            assert found["relaxed_elements"] == 0 and found["points_left"] == 0 and found["unmatched_curves"] == 0, found
            assert abs(found["target_volume"] - 2 * math.pi) < 1e-6 and abs(found["target_area"] - 6 * math.pi) < 1e-6, found
            assert abs(found["volume_error"] - (found["volume"] / found["target_volume"] - 1)) < 1e-15, found
            errors.append(found["volume"] / (2 * math.pi) - 1)
            areas.append(found["area"] / (6 * math.pi) - 1)
        assert rates(errors)[1] > order + 0.8 and rates(areas)[1] > order + 0.8, (order, errors, areas)
        # points of the rims lie on circles
        points = vtk_to_numpy(knotwork.read(FILES.path("curved.vtu")).GetPoints().GetData())
        rim = points[(np.abs(points[:, 2]) < 1e-12) & (np.hypot(points[:, 0], points[:, 1]) > 0.99)]
        assert len(rim) == 16 * order and np.abs(np.hypot(rim[:, 0], rim[:, 1]) - 1).max() < 1e-9, len(rim)
    FILES.run("validate", "curved.vtu")
    bezier = curved("rod.vtu", "rod.step", 4, "--basis", "bezier", output="bezier.vtu")
    assert abs(bezier["volume"] - found["volume"]) < 1e-12, bezier
    FILES.run("validate", "bezier.vtu")


def test_quadrilaterals_of_quads():
    """Areas of a ball, a torus and a plate with a hole. ConvergenceOracle."""
    if gmsh is None:
        knotwork_testing.skip("Gmsh's module for Python is not installed")
    parts = {
        "ball.step": (lambda occ: occ.addSphere(0, 0, 0, 1), 4 * math.pi),
        "torus.step": (lambda occ: occ.addTorus(0, 0, 0, 1, 0.4), 4 * math.pi**2 * 0.4),
        "plate.step": (lambda occ: occ.cut([(3, occ.addBox(-2, -2, 0, 4, 4, 1))], [(3, occ.addCylinder(0, 0, 0, 0, 0, 1, 1))]),
                       2 * (16 - math.pi) + 16 + 2 * math.pi),
    }
    for name, (make, area) in parts.items():
        part(name, make)
        for order in (2, 3, 4):
            errors, sizes = [], []
            for length, curvature in ((0.6, 30), (0.3, 15)):
                FILES.run("quads", name, "--edge-length", length, "--curvature", curvature, "--output", "quads.vtp", "--force", "--quiet")
                found = curved("quads.vtp", name, order)
                errors.append(abs(found["area"] / area - 1))
                sizes.append(found["elements"]**-0.5)
            # the meshes are no refinements of each other: their sizes are those of the mean element
            rate = math.log(errors[0] / errors[1]) / math.log(sizes[0] / sizes[1])
            assert rate > order + 0.5, (name, order, errors, sizes)


def test_what_gmsh_says():
    """Files of solvers: Gmsh's own integrals agree, and its determinants at their places are positive. CrossOracle."""
    if gmsh is None:
        knotwork_testing.skip("Gmsh's module for Python is not installed")
    part("rod.step", lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 2, 1))
    FILES.run("sweep", write_disc("disc.off", 2), "--direction", 0, 0, 2, "--layers", 4, "--output", "rod.vtu", "--force")
    FILES.run("source", "--shape", "ball", "--output", "ball.vtu", "--force")
    FILES.run("tetrahedralize", "ball.vtu", "--chordal-tolerance", 0.02, "--output", "tets.vtu", "--force", "--quiet")
    FILES.run("quads", "rod.step", "--edge-length", 0.6, "--output", "quads.vtp", "--force", "--quiet")
    for mesh, target, dimension in (("rod.vtu", "rod.step", 3), ("tets.vtu", "ball.vtu", 3), ("quads.vtp", "rod.step", 2)):
        for order in (2, 3, 4):
            found = curved(mesh, target, order, output="curved.msh")
            gmsh.initialize()
            gmsh.option.setNumber("General.Verbosity", 0)
            gmsh.open(FILES.path("curved.msh"))
            types, tags, _ = gmsh.model.mesh.getElements(dimension)
            assert [gmsh.model.mesh.getElementProperties(kind)[2] for kind in types] == [order], types
            assert len(tags[0]) == found["elements"]
            local, weights = gmsh.model.mesh.getIntegrationPoints(types[0], "Gauss8")
            determinants = np.reshape(gmsh.model.mesh.getJacobians(types[0], local)[1], (-1, len(weights)))
            measure = (determinants @ weights).sum()
            ours = found["volume" if dimension == 3 else "area"]
            assert abs(measure / ours - 1) < 1e-4, (mesh, order, measure, ours)
            if dimension == 3:
                assert determinants.min() > 0.0, (mesh, order, determinants.min())
            gmsh.finalize()
    again = FILES.report("validate", "curved.msh")
    assert again["verdict"] == "valid", again


def write_thin_tube(name):
    """A quarter of a tube around the third axis of two layers, the inner one thinner than the bulge of the straight elements."""
    radii, angles = (1.0, 1.03, 1.5), np.linspace(0, math.pi / 2, 3)
    points = [(r * math.cos(a), r * math.sin(a), z) for z in (0, 1) for a in angles for r in radii]
    cells = [[i + 3 * j + d + 9 * k for k in (0, 1) for d in (0, 1, 4, 3)] for j in (0, 1) for i in (0, 1)]
    with open(FILES.path(name), "w", encoding="utf-8") as file:
        file.write(f"# vtk DataFile Version 3.0\ntube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {len(points)} double\n")
        file.writelines("%.17g %.17g %.17g\n" % point for point in points)
        file.write(f"CELLS {len(cells)} {9 * len(cells)}\n")
        file.writelines("8 " + " ".join(map(str, cell)) + "\n" for cell in cells)
        file.write(f"CELL_TYPES {len(cells)}\n" + "12\n" * len(cells))
    return name


def test_bad_inputs():
    FILES.run("source", "--shape", "ball", "--output", "ball.vtu", "--force")
    disc = write_disc("disc.off", 1)
    for words, text in (
        ([disc, "--elements-only"], "--elements-only needs --target"),
        ([disc, "--target", "ball.vtu", "--elements-only", "--degree", 2], "--degree is of a smooth spline"),
        ([disc, "--target", "ball.vtu", "--order", 2], "--order is of elements alone"),
        ([disc, "--target", "ball.vtu", "--elements-only", "--entities", "e.csv"], "is of a smooth spline"),
        ([write_disc("far.off", 1, 1000.0), "--target", "ball.vtu", "--elements-only"], "give both in the same unit and place"),
        ([disc, "--target", "ball.vtu", "--elements-only", "--feature-array", "Nothing"], "no cell array 'Nothing'"),
        ([disc, "--target", "ball.vtu", "--elements-only", "--basis", "bezier", "--output", "no.msh"], "cannot hold such elements"),
        ([disc, "--target", "ball.vtu", "--output", "no.msh"], "cannot hold a smooth spline"),
    ):
        words = words if "--output" in words else [*words, "--output", "no.vtu"]
        done = FILES.run("cadfit", *words, status=1)
        assert text in done.stderr and len(done.stderr.strip().splitlines()) == 1, (words, done.stderr)
        assert not os.path.exists(FILES.path("no.vtu")) and not os.path.exists(FILES.path("no.msh"))
    with open(FILES.path("folded.vtk"), "w", encoding="utf-8") as file:
        with open(FILES.path(write_thin_tube("thin.vtk")), encoding="utf-8") as good:
            file.write(good.read().replace("8 0 1 4 3 9 10 13 12", "8 0 4 1 3 9 10 13 12"))
    done = FILES.run("cadfit", "folded.vtk", "--target", "ball.vtu", "--elements-only", "--output", "no.vtu", status=1)
    assert "is not valid though it is straight" in done.stderr, done.stderr
    FILES.run("cadfit", disc, "--target", "ball.vtu", "--elements-only", "--order", 5, "--output", "no.vtu", status=2)


knotwork_testing.main(globals())
