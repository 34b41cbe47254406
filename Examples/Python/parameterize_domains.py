# SPDX-License-Identifier: BSD-3-Clause
"""Domains whose interior is hard to fill, from their boundaries alone: a bar bent like the letter G from its six faces;
rectangles with a disc bitten out and sectors of an annulus with a bump from four curves, circular arcs among them, each
with fixed and with optimized weights. Every map, and what the parameterization says of it, is proved again by the
validator.

usage: parameterize_domains.py FOLDER [--write PAGE | --check PAGE]

Writes boundaries (.json), maps (.vtu) and the table (domains.md) into FOLDER. --write puts the table into the places
between the comments `example parameterize_domains ...: begin` and `... end` of a page; --check fails when what stands
there is not what has come out.
"""
import argparse
import json
import math
import os
import re
import sys

import knotwork
import numpy as np
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter


def clamped(degree, elements):
    return [0.0] * (degree + 1) + [i / elements for i in range(1, elements)] + [1.0] * (degree + 1)


def greville(degree, elements):
    knots = clamped(degree, elements)
    return [sum(knots[i + 1:i + degree + 1]) / degree for i in range(elements + degree)]


def segment(start, end, degree=1):
    """A straight line; of higher degree it has inner control points."""
    points = [np.add(start, np.multiply(i / degree, np.subtract(end, start))).tolist() for i in range(degree + 1)]
    return {"degree": degree, "knots": clamped(degree, 1), "control_points": points}


def arc(radius, begin, end):
    """Control points and weights of an exact arc about the origin, quadratic and rational, without its first point."""
    middle, weight = (begin + end) / 2, math.cos((end - begin) / 2)
    return [([radius / weight * math.cos(middle), radius / weight * math.sin(middle)], weight),
            ([radius * math.cos(end), radius * math.sin(end)], 1)]


def joined(start, *pieces):
    """Quadratic pieces that begin where the one before ends, as one curve."""
    rows = [(list(start), 1)] + [row for piece in pieces for row in piece]
    inner = [i / len(pieces) for i in range(1, len(pieces)) for _ in range(2)]
    return {"degree": 2, "knots": [0.0] * 3 + inner + [1.0] * 3, "weights": [w for _, w in rows],
            "control_points": [x for x, _ in rows]}


def bite(radius, middle, height, degree):
    """A rectangle of width 1 with a disc about (middle, 0) bitten out of its south side by two exact arcs."""
    left, right = middle - radius, middle + radius
    half = math.sqrt(0.5)
    return {"curves": [
        segment((0, 0), (0, height), degree), segment((1, 0), (1, height)),
        joined((0, 0), [([left / 2, 0], 1), ([left, 0], 1)], [([left, radius], half), ([middle, radius], 1)],
               [([right, radius], half), ([right, 0], 1)], [([(1 + right) / 2, 0], 1), ([1, 0], 1)]),
        segment((0, height), (1, height))]}


def bumped_sector(width, height, outer, degree=3, middle=0.5, angle=math.pi / 2):
    """A sector of an annulus between the radii 1 and outer. Out of its inner arc grows a bump, of 2 width of the arc's
    length and so high, about a place of it; everything else of the boundary is exact arcs and rays."""
    left, right, middle = (angle * t for t in (middle - width, middle + width, middle))
    at = lambda radius, a: [radius * math.cos(a), radius * math.sin(a)]  # noqa: E731
    top, half = 1 + height, math.sqrt(0.5)
    return {"curves": [
        joined((1, 0), arc(1, 0, left), [(at(top, left), half), (at(top, middle), 1)],
               [(at(top, right), half), (at(1, right), 1)], arc(1, right, angle)),
        joined((outer, 0), arc(outer, 0, angle)),
        segment((1, 0), (outer, 0), degree), segment(at(1, angle), at(outer, angle))]}


def letter_g(width, skew, elements=20, across=2, degree=2):
    """Six faces of a bar bent like the letter G: its axis is an arc of radius 1.2 through 295 degrees, a tighter turn to
    the left and a straight end. On the outer face positions along the axis run ahead by up to skew of its length."""
    pieces = [(1.2 * math.radians(295), 1 / 1.2), (0.5 * math.radians(105), 1 / 0.5), (0.35, 0.0)]  # length, curvature
    total = sum(length for length, _ in pieces)

    def axis(t):
        x, heading, rest = 1.2 * np.array([math.cos(math.radians(50)), math.sin(math.radians(50))]), \
            math.radians(140), t * total
        for length, curvature in pieces:
            s = min(rest, length)
            turned = heading + curvature * s
            if curvature > 0:
                x = x + np.array([math.sin(turned) - math.sin(heading), math.cos(heading) - math.cos(turned)]) / curvature
            else:
                x = x + s * np.array([math.cos(heading), math.sin(heading)])
            heading, rest = turned, rest - s
        return x, heading

    def point(u, v, w):
        x, heading = axis(u + skew * v * math.sin(math.pi * u) * math.sin(3 * math.pi * u))
        x = x + width * (v - 0.5) * np.array([-math.sin(heading), math.cos(heading)])
        return [x[0], x[1], 0.6 * w]

    counts = (elements, across, across)
    grevilles = [greville(degree, n) for n in counts]
    faces = []
    for direction in range(3):
        first, second = (d for d in range(3) if d != direction)
        for end in (0.0, 1.0):
            points = []
            for b in grevilles[second]:
                for a in grevilles[first]:
                    at = [end] * 3
                    at[first], at[second] = a, b
                    points.append(point(*at))
            faces.append({"degrees": [degree] * 2, "control_points": points,
                          "knots": [clamped(degree, counts[first]), clamped(degree, counts[second])]})
    return {"faces": faces}


def write_grid(grid, name):
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(name)
    writer.SetDataModeToBinary()  # which every ParaView reads
    if not writer.Write():
        sys.exit(1)  # VTK has said why


class Filled:
    """A boundary's map, what is said of it, and what the validator proves."""

    def __init__(self, folder, name, boundary, weights, refinements=0, **properties):
        file = os.path.join(folder, name + ".json")
        with open(file, "w") as stream:
            json.dump(boundary, stream)
        reader = knotwork.vtkDomainBoundaryReader()
        reader.SetFileName(file)
        domain = knotwork.vtkDomainParameterization()
        domain.SetInputConnection(reader.GetOutputPort())
        domain.SetWeights(weights)
        domain.SetMaximumRefinements(refinements)
        for key, value in properties.items():
            getattr(domain, "Set" + key)(value)
        domain.AddObserver("WarningEvent", lambda *ignored: None)  # invalid ones are expected, and checked below
        validator = knotwork.vtkJacobianValidator()
        validator.SetInputConnection(domain.GetOutputPort())
        validator.Update()
        if reader.GetErrorCode() or domain.GetErrorCode() or validator.GetErrorCode():
            sys.exit(1)  # VTK has said why
        table = validator.GetOutputDataObject(2)
        last = table.GetNumberOfRows() - 1
        self.verdict = table.GetValueByName(last, "Verdict").ToString()
        self.injective = table.GetValueByName(last, "Injective").ToString()
        field = domain.GetOutputDataObject(0).GetFieldData()
        self.said = field.GetAbstractArray("Verdict").GetValue(0)
        self.minimum = field.GetArray("MinDetOverArea").GetTuple1(0)
        self.maximum = field.GetArray("MaxDetOverArea").GetTuple1(0)
        self.scaled = field.GetArray("MinScaledJacobian").GetTuple1(0)
        self.condition = field.GetArray("MeanConditionNumber").GetTuple1(0)
        self.functions = int(field.GetArray("Functions").GetTuple1(0))
        suffix = {domain.WEIGHTS_FIXED: "fixed", domain.WEIGHTS_OPTIMIZED: "optimized"}.get(weights, "automatic")
        write_grid(validator.GetOutputDataObject(0), os.path.join(folder, f"{name}_{suffix}.vtu"))
        if self.verdict == "valid" and self.injective != "injective":
            sys.exit(f"{name}: {self.injective}")
        if self.said != self.verdict:
            sys.exit(f"{name}: said to be {self.said}, proved {self.verdict}")
        if self.verdict == "invalid" and validator.GetOutputDataObject(1).GetNumberOfCells() == 0:
            sys.exit(f"{name}: invalid without a point that shows it")

    def cells(self):
        return [self.verdict, f"{self.minimum:.4f}", f"{self.scaled:.4f}"]


# radius and middle of the disc, height, degree from south to north
BITES = [(0.46, 0.5, 1.2, 3), (0.46, 0.5, 3, 3), (0.49, 0.5, 4, 3), (0.49, 0.5, 4, 2), (0.49, 0.5, 6, 2), (0.49, 0.5, 8, 2),
         (0.43, 0.48, 4, 3)]
# half width and height of the bump, outer radius, degree across, place of the bump
SECTORS = [(0.46, 0.4, 2, 2, 0.48), (0.46, 1.2, 4, 2, 0.48), (0.46, 0.4, 2, 3, 0.48), (0.46, 1.2, 2.92, 3, 0.48),
           (0.46, 2, 6, 3, 0.5), (0.38, 1.2, 4, 3, 0.5)]
LETTERS = [(0.4, 0), (0.6, 0.05), (0.6, 0.1), (0.65, 0.1)]  # width, skew


def weights_table(folder):
    rows = [["domain", "fixed weights", "min det J / S", "scaled", "optimized weights", "min det J / S", "scaled"]]
    domains = [(f"bite {r:g} at {x:g}, height {h:g}, degree {p}", f"bite_{i}", bite(r, x, h, p))
               for i, (r, x, h, p) in enumerate(BITES)]
    domains += [(f"sector to {R:g}, bump {w:g} x {h:g} at {x:g}, degree {p}", f"sector_{i}",
                 bumped_sector(w, h, R, p, x)) for i, (w, h, R, p, x) in enumerate(SECTORS)]
    modes = knotwork.vtkDomainParameterization
    won = 0
    for title, name, boundary in domains:
        fixed, free = (Filled(folder, name, boundary, mode) for mode in (modes.WEIGHTS_FIXED, modes.WEIGHTS_OPTIMIZED))
        won += fixed.verdict == "invalid" and free.verdict == "valid"
        if fixed.verdict == "valid" and free.verdict != "valid":
            sys.exit(f"{title}: optimized weights lose the certificate")
        rows.append([title, *fixed.cells(), *free.cells()])
        if fixed.verdict != "valid" and free.verdict == "valid":
            rows[-1][4] = "**valid**"
    if not won:
        sys.exit("weights make no invalid map valid")
    return rows


def terms_table(folder):
    """The published method - weights begin at 1, ReLU - with and without the uniformity term, fixed and optimized weights."""
    modes = knotwork.vtkDomainParameterization
    domains = [(f"bite {r:g} at {x:g}, height {h:g}, degree {p}", f"terms_bite_{i}", bite(r, x, h, p))
               for i, (r, x, h, p) in enumerate([(0.4, 0.5, 1, 3), (0.43, 0.48, 4, 3)])]
    domains += [(f"sector to {R:g}, bump {w:g} x {h:g} at {x:g}, degree {p}", f"terms_sector_{i}",
                 bumped_sector(w, h, R, p, x)) for i, (w, h, R, p, x) in enumerate(SECTORS[2:])]
    rows = [["domain", "lambda", "weights", "verdict", "min det J / S", "max det J / S", "scaled", "mean condition"]]
    for title, name, boundary in domains:
        for uniformity in (0, 1):
            for word, weights in (("fixed", modes.WEIGHTS_FIXED), ("optimized", modes.WEIGHTS_OPTIMIZED)):
                made = Filled(folder, f"{name}_{uniformity}", boundary, weights, InitialMap=modes.COONS,
                              InitialWeights=modes.ONES, Foldover=modes.RELU, UniformityWeight=uniformity)
                rows.append([title, str(uniformity), word, made.verdict, f"{made.minimum:.4f}", f"{made.maximum:.3f}",
                             f"{made.scaled:.4f}", f"{made.condition:.3f}"])
    return rows


def volume_table(folder):
    rows = [["letter G", "functions", "verdict", "one-to-one", "min det J / S", "max det J / S", "scaled"]]
    for i, (width, skew) in enumerate(LETTERS):
        filled = Filled(folder, f"letter_g_{i}", letter_g(width, skew),
                        knotwork.vtkDomainParameterization.WEIGHTS_AUTOMATIC, refinements=3)
        if filled.verdict != "valid":
            sys.exit(f"the letter G of width {width} is not valid")
        rows.append([f"width {width:g}, skew {skew:g}", str(filled.functions), filled.verdict,
                     filled.injective.replace("_", " "), f"{filled.minimum:.4f}", f"{filled.maximum:.3f}",
                     f"{filled.scaled:.4f}"])
    return rows


def markdown(rows):
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + " --- |" * len(rows[0]), *lines[1:]]) + "\n"


def same(text, other):
    """Words alike, numbers to 2 % and two units of the last digit: other processors round otherwise."""
    pattern = r"-?\d+(?:\.\d+)?"
    numbers = [[float(word) for word in re.findall(pattern, t)] for t in (text, other)]
    return re.sub(pattern, "#", text) == re.sub(pattern, "#", other) and all(
        abs(a - b) <= 2e-4 + 0.02 * max(abs(a), abs(b)) for a, b in zip(*numbers))


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--write")
    parser.add_argument("--check")
    arguments = parser.parse_args()
    os.makedirs(arguments.folder, exist_ok=True)
    tables = {"weights": markdown(weights_table(arguments.folder)), "terms": markdown(terms_table(arguments.folder)),
              "volumes": markdown(volume_table(arguments.folder))}
    with open(os.path.join(arguments.folder, "domains.md"), "w") as stream:
        stream.write("\n".join(tables.values()))
    print("\n".join(tables.values()), end="")
    page = arguments.write or arguments.check
    if page:
        with open(page, encoding="utf-8") as stream:
            text = stream.read()
        for name, table in tables.items():
            begin, end = (f"<!-- example parameterize_domains {name}: {word} -->\n" for word in ("begin", "end"))
            before, rest = text.split(begin)
            old, after = rest.split(end)
            if arguments.check and not same(old, table):
                sys.exit(f"{page}: the table {name} is not what has come out; run with --write")
            text = before + begin + table + end + after
        if arguments.write:
            with open(page, "w", encoding="utf-8") as stream:
                stream.write(text)


if __name__ == "__main__":
    main()
