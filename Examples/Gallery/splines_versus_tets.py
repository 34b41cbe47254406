# SPDX-License-Identifier: BSD-3-Clause
"""Linear elasticity on splines of degree 2 and 3 and on curved quadratic tetrahedra (splines_versus_tets.png): a plate with a hole under tension (Kirsch)
and three quarters of a solid torus, held on its boundary, under a force in its volume, against known solutions; a quarter of a connecting rod that pins pull,
against a finer spline. Errors in energy and of the peak stress by functions and by seconds of one thread, those of meshing and fitting too; shapes
that are splines are given.

usage: splines_versus_tets.py [--output DIR]
"""
import json
import math
import os
import subprocess

import numpy as np

import _cases as cases
import _scene as scene
from cad_modification import PROGRAM

RATIO = 0.3
SHEAR = 1 / (2 * (1 + RATIO))  # of modulus 1


def plate():
    """Kirsch's displacements in plane strain: Timoshenko, Goodier, Theory of Elasticity, 1951, article 35. A quarter, with the ends of z held in z."""
    a, k = 0.5, 3 - 4 * RATIO
    r2, c2, s2 = "(x*x + y*y)", "((x*x - y*y) / (x*x + y*y))", "(2*x*y / (x*x + y*y))"
    across = f"({1 / (4 * SHEAR)} * ({(k - 1) / 2} + {a * a}/{r2} + {c2} * (1 + {(k + 1) * a * a}/{r2} - {a ** 4}/{r2}^2)))"
    along = f"(-{1 / (4 * SHEAR)} * {s2} * (1 + {(k - 1) * a * a}/{r2} + {a ** 4}/{r2}^2))"
    exact = [f"{across} * x - {along} * y", f"{across} * y + {along} * x", "0"]
    conditions = [{"on": {"where": place}, "displacement": given}
                  for place, given in (("abs(x) < 1e-6", [0, exact[1], None]), ("abs(y) < 1e-6", [exact[0], 0, None]), ("abs(abs(z) - 0.25) < 1e-6", [None, None, 0]),
                                       ("x*nx + y*ny > 0.9 * sqrt(x*x + y*y)", exact[:2] + [None]))]
    # hoop stress 3 beside the hole, ratio times that along it
    return {"exact": exact, "conditions": conditions}, 3 * math.sqrt(1 - RATIO + RATIO ** 2)


def torus():
    """Displacements (sin y, sin z, sin x) / 10, which keep volumes: the force is the shear modulus times them."""
    exact = ["0.1*sin(y)", "0.1*sin(z)", "0.1*sin(x)"]
    # von Mises' stress is that of three shear stresses; its largest on the torus is where the body is nearest to the axis, in the plane z = 0
    angle = np.linspace(0, 1.5 * math.pi, 100001)
    x, y = (1 - TUBE) * np.cos(angle), (1 - TUBE) * np.sin(angle)
    peak = math.sqrt(3) * 0.1 * SHEAR * np.sqrt(np.cos(x) ** 2 + np.cos(y) ** 2 + 1).max()
    return {"exact": exact, "source": [f"{SHEAR}*{each}" for each in exact], "conditions": [{"on": "boundary", "displacement": exact}]}, peak


def rod():
    """Pins pull at both bores, with the same force: the pressure goes with the square of the cosine. What is fixed in x feels none of it."""
    conditions = [{"on": {"where": "abs(y) < 1e-6"}, "displacement": [None, 0, None]}, {"on": {"where": "abs(z) < 1e-6"}, "displacement": [None, None, 0]},
                  {"at": [-20, 0, 0], "displacement": [0, None, None]}]
    for centre, radius, way in ((60, 7, 1), (0, 12, -1)):
        conditions.append({"on": {"where": f"((x-{centre})^2 + y^2 < {1.5 * radius ** 2}) and (nx*(x-{centre}) + ny*y < -1)"},
                           "traction": [f"{way * 7 / radius} * max(0, {-way}*nx)^2", 0, 0]})
    return {"conditions": conditions}, None


TUBE = 0.3  # radius of the torus' tube; its axis has radius 1
ROD = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Testing", "Data", "Parts", "rod.step")
# the problem; how a spline of a degree is made; by degree, of how many elements or of which size; what tetrahedra are made of; their sizes
SHAPES = {
    "plate with a hole": (plate, ("--shape", "solid-tube", "--inner-radius", 0.5, "--outer-radius", 2, "--height", 0.5),
                          {2: [(4, 4, 1), (8, 8, 1), (16, 16, 1)], 3: [(3, 3, 1), (6, 6, 1), (12, 12, 1)]}, [0.5, 0.25, 0.15]),
    "solid torus": (torus, ("--shape", "solid-torus", "--inner-radius", TUBE, "--angle", 270),
                    {2: [(1, 1, 2), (2, 2, 3), (3, 3, 5)], 3: [(1, 1, 2), (1, 1, 3), (2, 2, 3)]}, [0.3, 0.2, 0.15]),
    "connecting rod": (rod, None, {2: [6, 4, 3], 3: [6, 4, 3]}, [4, 3, 2]),
}
FINEST = 1.5  # of the rod's reference, of degree 3


def run(folder, *words):
    """One job in the folder; its report."""
    report = os.path.join(folder, "versus.json")
    subprocess.run([PROGRAM, *(str(word) for word in words), "--report", report, "--force", "--quiet", "--threads", "1"], check=True, cwd=folder)
    with open(report, encoding="utf-8") as file:
        return json.load(file)


def make_spline(folder, shape, degree, size):
    """Seconds that it takes; a source is given."""
    if shape:
        run(folder, "source", *shape, "--degree", degree, "--elements", *size, "--output", "versus_spline.vtu")
        return 0.0
    return sum(run(folder, *words)["cpu_seconds"] for words in (
        ("hexes", ROD, "--edge-length", size, "--output", "versus_hexes.vtu"),
        ("cadfit", "versus_hexes.vtu", "--target", ROD, "--degree", degree, "--output", "versus_spline.vtu")))


def make_tetrahedra(folder, target, size):
    return sum(run(folder, *words)["cpu_seconds"] for words in (
        ("boundary", target, "--chordal-tolerance", 1e-2, "--output", "versus_surface.vtp"),
        ("remesh", "versus_surface.vtp", "--size", size, "--output", "versus_triangles.vtp"),
        ("tetrahedralize", "versus_triangles.vtp", "--target", target, "--order", 2, "--edge-length", size, "--output", "versus_tets.vtu")))


def solve(folder, body):
    return run(folder, "solve", "elasticity", body, "versus_problem.json", "--output", "versus_solved.vtu")


def measured(folder, body):
    """(name, rows) of the three kinds of spaces; a row: functions, seconds, errors in energy and of the peak."""
    make, shape, sizes, lengths = SHAPES[body]
    problem, peak = make()
    problem["material"] = {"youngs_modulus": 1, "poissons_ratio": RATIO}
    with open(os.path.join(folder, "versus_problem.json"), "w", encoding="utf-8") as file:
        json.dump(problem, file)
    finest = None
    if "exact" not in problem:
        make_spline(folder, shape, 3, FINEST)
        finest = solve(folder, "versus_spline.vtu")
        peak = finest["peak_stress"]

    def row(file, prepared):
        report = solve(folder, file)
        if finest:  # nothing but 0 is prescribed: the square of the error is twice the difference of the potentials
            energy = math.sqrt(abs(report["potential"] - finest["potential"]) / finest["energy"])
        else:
            energy = report["energy_error"] / report["exact_energy"]
        seconds = prepared + sum(report[f"{step}_seconds"] for step in ("certificate", "assembly", "solution"))
        return report["functions"], seconds, energy, abs(report["peak_stress"] / peak - 1)

    found = [(f"splines, degree {degree}", [row("versus_spline.vtu", make_spline(folder, shape, degree, size)) for size in each])
             for degree, each in sizes.items()]
    target = ROD
    if shape:
        target = "versus_target.vtu"
        run(folder, "source", *shape, "--output", target)
    return found + [("curved tetrahedra, order 2", [row("versus_tets.vtu", make_tetrahedra(folder, target, size)) for size in lengths])]


def main():
    folder = os.path.abspath(scene.output_folder())
    pixels, band = (500, 400), 60
    height = len(SHAPES) * pixels[1] + band
    panels = []
    for k, body in enumerate(SHAPES):
        found = measured(folder, body)
        for name, rows in found:
            for functions, seconds, energy, peak in rows:
                print(f"{body}, {name}: {functions} functions, {seconds:.2f} s, {energy:.2e} error in energy, {peak:.2e} of the peak")
        below = height - (k + 1) * pixels[1]
        for column, (x, y, across, up) in enumerate(((0, 2, "functions", "error in energy"), (1, 2, "seconds", "error in energy"),
                                                     (0, 3, "functions", "error of the peak stress"))):
            viewport = (column / 3, below / height, (column + 1) / 3, (below + pixels[1]) / height)
            series = [(name, [row[x] for row in rows], [row[y] for row in rows]) for name, rows in found]
            panels.append(cases.plot(series, pixels, viewport, (f"{body}: {across}", up), log_x=True, legend=False))
    words = scene.renderer([], viewport=(0.0, 0.0, 1.0, band / height))
    for place, (name, _) in enumerate(found):
        line = scene.label(name, 0.1 + 0.3 * place, 0.3, 20)
        line.GetTextProperty().SetColor(*scene.COLOURS[4 + place])  # of the plots
        words.AddActor(line)
    panels.append(words)
    scene.save(panels, os.path.join(folder, "splines_versus_tets.png"), (3 * pixels[0], height))


if __name__ == "__main__":
    main()
