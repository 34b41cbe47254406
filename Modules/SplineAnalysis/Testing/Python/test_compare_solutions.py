# SPDX-License-Identifier: BSD-3-Clause
"""The job `compare --solve`: a spline and curved tetrahedra against known solutions and against finer bodies, and errors."""
import json
import math

import knotwork_testing
from knotwork_testing import Files

import knotwork

FILES = Files("compare_solutions", 300)


def write(name, problem):
    with open(FILES.path(name), "w", encoding="utf-8") as stream:
        json.dump(problem, stream)
    return FILES.path(name)


def bodies():
    """A cube as a spline and as quadratic tetrahedra of its boundary."""
    spline, mesh = FILES.path("box.vtu"), FILES.path("tets.vtu")
    FILES.run("source", "--shape", "cube", "--degree", 2, "--elements", 3, 3, 3, "--output", spline)
    FILES.run("boundary", spline, "--output", FILES.path("box.vtp"))
    FILES.run("tetrahedralize", FILES.path("box.vtp"), "--order", 2, "--edge-length", 0.4, "--output", mesh)
    return spline, mesh


def test_both_have_a_quadratic_solution():
    spline, mesh = bodies()
    # modulus 1, ratio 0, u = (x^2, x y, 0): strains 2 x, x, y / 2, so that div stress = (2 + 1 / 2, 0, 0)
    given = ["x^2", "x*y", "0"]
    problem = write("quadratic.json", {"material": {"youngs_modulus": 1, "poissons_ratio": 0}, "source": [-2.5, 0, 0], "exact": given,
                                       "conditions": [{"on": "boundary", "displacement": given}]})
    report = FILES.report("compare", spline, mesh, "--solve", problem, "--equation", "elasticity", "--mesh-solution", FILES.path("solved.vtu"),
                          "--output", FILES.path("table.csv"))
    for body in ("spline", "mesh"):
        # rounding of fourth-order differences of the known solution: 1e-11
        assert report[f"{body}_energy_error"] < 1e-9 and report[f"{body}_l2_error"] < 1e-12, report
    assert "reference_energy" not in report and report["mesh_functions"] > report["spline_functions"] > 0
    assert "Displacement" in knotwork.read(FILES.path("solved.vtu")).point_arrays


def test_errors_by_a_finer_body_are_those_by_the_solution():
    files = []
    for degree, elements in ((2, 8), (2, 16), (4, 24)):
        files.append(FILES.path(f"ring{elements}.vtu"))
        FILES.run("source", "--shape", "annulus-sector", "--degree", degree, "--elements", elements, elements, 1, "--output", files[-1])
    known = "sin(3*x) * exp(y)"
    conditions = [{"on": {"where": "abs(x) < 1e-9"}, "value": 0}, {"on": {"where": "abs(y) < 1e-9"}, "value": "sin(3*x)"},
                  {"on": {"where": "abs(x * x + y * y - 1) < 1e-9"}, "flux": "3*cos(3*x)*exp(y)*nx + sin(3*x)*exp(y)*ny"},
                  {"on": {"where": "abs(x * x + y * y - 0.25) < 1e-9"}, "value": known}]
    heat = {"source": "8*sin(3*x)*exp(y)", "conditions": conditions}
    by_body = FILES.report("compare", files[0], files[1], "--reference", files[2], "--solve", write("heat.json", heat), "--equation", "poisson",
                           "--output", FILES.path("table.csv"))
    heat["exact"] = known
    by_solution = FILES.report("compare", files[0], files[1], "--solve", write("known.json", heat), "--equation", "poisson", "--output", FILES.path("table.csv"))
    for body in ("spline", "mesh"):
        # the energy of the projected values on the boundary differs a little
        assert abs(by_body[f"{body}_energy_error"] / by_solution[f"{body}_energy_error"] - 1) < 0.05, (by_body, by_solution)
        solved = FILES.report("solve", "poisson", files[body == "mesh"], FILES.path("known.json"), "--output", FILES.path("solved.vtu"))
        assert math.isclose(solved["energy_error"] / solved["exact_energy"], by_solution[f"{body}_energy_error"], rel_tol=1e-12)
        assert solved["energy"] == by_body[f"{body}_energy"] and solved["peak_flux"] == by_body[f"{body}_peak"]
    ratio = by_solution["spline_energy_error"] / by_solution["mesh_energy_error"]
    assert 3.6 < ratio < 4.6, ratio  # order 2
    assert by_body["reference_energy_error"] == 0 and 0 < by_body["mesh_peak_error"] < by_body["spline_peak_error"] < 0.1, by_body


def test_function():
    ring = knotwork.source("annulus-sector", degree=2, elements=[3, 3, 1])
    fine = knotwork.source("annulus-sector", degree=3, elements=[6, 6, 1])
    problem = json.dumps({"conditions": [{"on": {"where": "abs(x) < 1e-9"}, "displacement": [0, 0]}, {"on": {"where": "abs(y) < 1e-9"}, "traction": [0, 1]}]})
    table = ring.compare_solutions(mesh=fine, reference=fine, equation="elasticity", problem=problem).outputs["numbers"]
    assert list(table.columns["Body"]) == ["spline", "mesh", "reference"] and table.columns["EnergyError"][1] == 0


def test_errors_are_one_line():
    spline = FILES.path("small.vtu")
    FILES.run("source", "--shape", "annulus-sector", "--output", spline)
    problem = write("held.json", {"conditions": [{"on": "boundary", "value": 0}]})
    for words, place in ((("--solve", problem), "give a finer body"),
                         (("--solve", problem, "--equation", "elasticity"), "the spline: condition 0"),
                         (("--solve", FILES.path("none.json")), "none.json"),
                         (("--solve", problem, "--histogram", FILES.path("h.csv")), "--solve compares no shapes"),
                         (("--mesh-solution", FILES.path("m.vtu")), "need --solve"),
                         (("--plane", "strain"), "--solve")):
        done = knotwork_testing.run_program("compare", spline, spline, *words, "--output", FILES.path("none.csv"))
        assert done.returncode != 0 and len(done.stderr.splitlines()) == 1 and place in done.stderr, done


knotwork_testing.main(globals())
