# SPDX-License-Identifier: BSD-3-Clause
"""Linear elasticity on splines of degree 2 and 3 and on curved quadratic tetrahedra, against known solutions: a plate with a hole under tension (Kirsch)
and three quarters of a solid torus, held on its boundary, under a force in its volume (splines_versus_tets.png). Errors in energy and of the peak
stress by functions and by seconds of one thread: of the tetrahedra those of meshing too, of splines, which are given, certificate, assembly and solution.

usage: splines_versus_tets.py [--output DIR]
"""
import json
import math
import os
import subprocess

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
    """Displacements (sin y, sin z, sin x) / 10, which keep volumes: the force is the shear modulus times them. Its peak is not
    compared."""
    exact = ["0.1*sin(y)", "0.1*sin(z)", "0.1*sin(x)"]
    return {"exact": exact, "source": [f"{SHEAR}*{each}" for each in exact], "conditions": [{"on": "boundary", "displacement": exact}]}, None


BODIES = {
    "plate with a hole": (plate, ("--shape", "solid-tube", "--inner-radius", 0.5, "--outer-radius", 2, "--height", 0.5),
                          {2: [(4, 4, 1), (8, 8, 1), (16, 16, 1)], 3: [(3, 3, 1), (6, 6, 1), (12, 12, 1)]}, [0.5, 0.25, 0.15]),
    "solid torus": (torus, ("--shape", "solid-torus", "--inner-radius", 0.3, "--angle", 270),
                    {2: [(1, 1, 2), (2, 2, 3), (3, 3, 5)], 3: [(1, 1, 2), (1, 1, 3), (2, 2, 3)]}, [0.3, 0.2, 0.15]),
}


def run(folder, *words):
    """One job in the folder; its report."""
    report = os.path.join(folder, "versus.json")
    subprocess.run([PROGRAM, *(str(word) for word in words), "--report", report, "--force", "--quiet", "--threads", "1"], check=True, cwd=folder)
    with open(report, encoding="utf-8") as file:
        return json.load(file)


def solved(folder, body, prepared, peak):
    """Functions, seconds, errors in energy and of the peak."""
    report = run(folder, "solve", "elasticity", body, "versus_problem.json", "--output", "versus_solved.vtu")
    seconds = prepared + sum(report[f"{step}_seconds"] for step in ("certificate", "assembly", "solution"))
    return (report["functions"], seconds, report["energy_error"] / report["exact_energy"],
            abs(report["peak_stress"] / peak - 1) if peak else 0.0)


def measured(folder, body):
    """(name, rows) of the three kinds of spaces."""
    make, shape, elements, sizes = BODIES[body]
    problem, peak = make()
    problem["material"] = {"youngs_modulus": 1, "poissons_ratio": RATIO}
    with open(os.path.join(folder, "versus_problem.json"), "w", encoding="utf-8") as file:
        json.dump(problem, file)
    found = []
    for degree, counts in elements.items():
        rows = []
        for count in counts:
            run(folder, "source", *shape, "--degree", degree, "--elements", *count, "--output", "versus_spline.vtu")
            rows.append(solved(folder, "versus_spline.vtu", 0.0, peak))
        found.append((f"splines, degree {degree}", rows))
    rows = []
    run(folder, "source", *shape, "--output", "versus_target.vtu")
    for size in sizes:
        seconds = sum(run(folder, *words)["cpu_seconds"] for words in (
            ("boundary", "versus_target.vtu", "--chordal-tolerance", 1e-2, "--output", "versus_surface.vtp"),
            ("remesh", "versus_surface.vtp", "--size", size, "--output", "versus_triangles.vtp"),
            ("tetrahedralize", "versus_triangles.vtp", "--target", "versus_target.vtu", "--order", 2, "--edge-length", size, "--output", "versus_tets.vtu")))
        rows.append(solved(folder, "versus_tets.vtu", seconds, peak))
    return found + [("curved tetrahedra, order 2", rows)]


def main():
    folder = os.path.abspath(scene.output_folder())
    pixels = (500, 400)
    panels = []
    for k, body in enumerate(BODIES):
        found = measured(folder, body)
        for name, rows in found:
            for functions, seconds, energy, peak in rows:
                print(f"{body}, {name}: {functions} functions, {seconds:.2f} s, {energy:.2e} error in energy" + (f", {peak:.2e} of the peak" if peak else ""))
        charts = [(0, 2, "functions", "error in energy"), (1, 2, "seconds", "error in energy")] + [(0, 3, "functions", "error of the peak stress")] * (k == 0)
        for column, (x, y, across, up) in enumerate(charts):
            viewport = (column / 3, 0.5 - 0.5 * k, (column + 1) / 3, 1 - 0.5 * k)
            series = [(name, [row[x] for row in rows], [row[y] for row in rows]) for name, rows in found]
            panels.append(cases.plot(series, pixels, viewport, (f"{body}: {across}", up), log_x=True, legend=False))
    words = scene.renderer([], viewport=(2 / 3, 0.0, 1.0, 0.5))
    for row, (name, _) in enumerate(found):
        line = scene.label(name, 0.1, 0.75 - 0.12 * row, 20)
        line.GetTextProperty().SetColor(*scene.COLOURS[4 + row])  # of the plots
        words.AddActor(line)
    panels.append(words)
    scene.save(panels, os.path.join(folder, "splines_versus_tets.png"), (3 * pixels[0], 2 * pixels[1]))


if __name__ == "__main__":
    main()
