# SPDX-License-Identifier: BSD-3-Clause
"""Solutions of the theory of elasticity that are known in closed form: what `solve` finds of them, and how fast the error falls. Loads that
the theory has (pressures, free faces) are given as loads, the rest of the boundary by the displacements."""
import json
import math

import knotwork_testing
from knotwork_testing import Files

import knotwork

FILES = Files("exact_solutions", 300)
MODULUS, RATIO = 1000.0, 0.3
SHEAR = MODULUS / (2 * (1 + RATIO))


def errors(shape, words, elements, exact, conditions):
    """Shares of the error in energy at each of the numbers of elements, and the reports."""
    problem = FILES.path("problem.json")
    with open(problem, "w", encoding="utf-8") as stream:
        json.dump({"material": {"youngs_modulus": MODULUS, "poissons_ratio": RATIO}, "exact": exact, "conditions": conditions}, stream)
    found = []
    for each in elements:
        FILES.run("source", "--shape", shape, *words, "--degree", 2, "--elements", *each, "--output", FILES.path("body.vtu"), "--force")
        report = FILES.report("solve", "elasticity", FILES.path("body.vtu"), problem, "--output", FILES.path("solved.vtu"))
        found.append(report)
    shares = [report["energy_error"] / report["exact_energy"] for report in found]
    return shares, found


def expect_order(shares, order, largest):
    rate = math.log2(shares[0] / shares[1])
    assert order - 0.3 < rate < order + 0.6 and shares[1] < largest, (shares, rate)


def test_sphere_under_pressure():
    # Timoshenko, Goodier, Theory of Elasticity, 1951, article 125
    inner, outer, pressure = 0.5, 1.0, 3.0
    scale = pressure * inner ** 3 / (MODULUS * (outer ** 3 - inner ** 3))
    radial = f"({scale * (1 - 2 * RATIO)} + {scale * (1 + RATIO) / 2 * outer ** 3} / (x*x + y*y + z*z)^1.5)"
    exact = [f"{radial} * {axis}" for axis in "xyz"]
    conditions = [{"on": {"where": "abs(x*x + y*y + z*z - 0.25) < 1e-9"}, "pressure": pressure}]
    # the planes and cones that bound the sector; outside it is free
    conditions += [{"on": {"where": f"abs({side}) < 1e-9"}, "displacement": exact} for side in ("x", "y", "4*z*z - (x*x + y*y + z*z)")]
    shares, reports = errors("ball-sector", ("--inner-radius", inner, "--polar-angle", 60), [(2, 2, 2), (4, 4, 4)], exact, conditions)
    expect_order(shares, 2, 0.03)
    # inside: hoop stress p (2 a^3 + b^3) / (2 (b^3 - a^3)), radial -p
    mises = pressure * (2 * inner ** 3 + outer ** 3) / (2 * (outer ** 3 - inner ** 3)) + pressure
    assert abs(reports[1]["peak_stress"] / mises - 1) < 0.05, reports[1]


def test_plate_with_a_hole_under_tension():
    # Kirsch; Timoshenko, Goodier, article 35, with displacements in plane stress
    a, tension = 0.5, 1.0
    k = (3 - RATIO) / (1 + RATIO)
    c2, s2 = "((x*x - y*y) / (x*x + y*y))", "(2*x*y / (x*x + y*y))"
    r2 = "(x*x + y*y)"
    # u_r and u_theta over r
    ur = f"({tension / (4 * SHEAR)} * (({(k - 1) / 2} + {a * a} / {r2}) + {c2} * (1 + {(k + 1) * a * a} / {r2} - {a ** 4} / {r2}^2)))"
    ut = f"(-{tension / (4 * SHEAR)} * {s2} * (1 + {(k - 1) * a * a} / {r2} + {a ** 4} / {r2}^2))"
    exact = [f"{ur} * x - {ut} * y", f"{ur} * y + {ut} * x"]
    # the hole is free
    conditions = [{"on": {"where": f"abs({side}) < 1e-9"}, "displacement": exact} for side in ("x", "y", "x*x + y*y - 4")]
    shares, reports = errors("annulus-sector", ("--inner-radius", a, "--outer-radius", 2), [(8, 8, 1), (16, 16, 1)], exact, conditions)
    expect_order(shares, 2, 0.006)
    assert abs(reports[1]["peak_stress"] / (3 * tension) - 1) < 0.01, reports[1]


def test_twisted_shaft():
    # Saint-Venant: a circular shaft twisted by t a unit of length; its side and inner face are free
    twist = 0.1
    exact = [f"-{twist} * y * z", f"{twist} * x * z", "0"]
    conditions = [{"on": {"where": f"abs(z - {end}) < 1e-9"}, "displacement": exact} for end in (-0.5, 0.5)]
    conditions += [{"on": {"where": f"abs({axis}) < 1e-9"}, "displacement": exact} for axis in "xy"]
    shares, reports = errors("solid-tube", ("--inner-radius", 0.5), [(1, 1, 1), (2, 2, 2)], exact, conditions)
    assert max(shares) < 1e-11, shares  # x z and y z are products of what the body's own functions make
    # shear stress G t r, largest at the outer radius 1
    assert abs(reports[1]["peak_stress"] / (math.sqrt(3) * SHEAR * twist) - 1) < 1e-9, reports[1]


def test_twisted_bar_of_square_section():
    # Saint-Venant: Timoshenko, Goodier, article 109; functions of Python, for the warping is a series
    half, twist = 0.5, 0.1
    terms = [(-1) ** n * 32 * half ** 2 / ((2 * n + 1) * math.pi) ** 3 for n in range(40)]
    waves = [(2 * n + 1) * math.pi / (2 * half) for n in range(40)]

    def warping(x, y):
        # sinh(k x) / cosh(k a) without numbers that overflow
        return -x * y + sum(c * math.copysign(math.exp(k * (abs(x) - half)) - math.exp(-k * (abs(x) + half)), x) / (1 + math.exp(-2 * k * half)) *
                            math.sin(k * y) for c, k in zip(terms, waves))

    def moved(x, y, z):
        return -twist * z * y, twist * z * x, twist * warping(x, y)

    problem = {"material": {"youngs_modulus": MODULUS, "poissons_ratio": RATIO}, "exact": moved,
               "conditions": [{"on": {"where": lambda x, y, z: abs(abs(z) - half) < 1e-9}, "displacement": moved}]}  # its sides are free
    shares = []
    for n in (4, 8):
        solved = knotwork.source("cube", degree=2, elements=[n, n, 2]).solve(equation="elasticity", problem=problem)
        numbers = {name: column[0] for name, column in solved.outputs["numbers"].columns.items()}
        shares.append(numbers["EnergyError"] / numbers["ExactEnergy"])
    expect_order(shares, 2, 0.012)
    # article 109's table: the torsional constant 0.1406 (2 a)^4, the largest shear stress 0.675 G t (2 a)
    assert abs(numbers["Energy"] / (0.5 * SHEAR * twist ** 2 * 0.1406) - 1) < 1e-3, numbers
    assert abs(numbers["PeakStress"] / (math.sqrt(3) * 0.675 * SHEAR * twist) - 1) < 0.01, numbers


def test_load_on_a_half_space():
    # Boussinesq: a force 1 down at (0, 0, 2) on the body z < 2; what the cube below feels. Timoshenko, Goodier, article 123
    depth = "(2 - z)"
    r2 = f"(x*x + y*y + {depth}^2)"
    distance = f"sqrt({r2})"
    scale = 1 / (4 * math.pi * SHEAR)
    along = f"{scale} * ({depth} / {distance}^3 - {1 - 2 * RATIO} / ({distance} * ({distance} + {depth})))"
    exact = [f"{along} * x", f"{along} * y", f"-{scale} * ({2 * (1 - RATIO)} / {distance} + {depth}^2 / {distance}^3)"]
    shares, _ = errors("cube", (), [(2, 2, 2), (4, 4, 4)], exact, [{"on": "boundary", "displacement": exact}])
    expect_order(shares, 2, 0.02)


knotwork_testing.main(globals())
