# SPDX-License-Identifier: BSD-3-Clause
"""`parameterize` fills outlines that were drawn by hand, from every format of lines; polygons become meshes of solvers."""
import json
import math

import knotwork
import knotwork_testing
from refusals import good, path, refuse, write_text

STADIUM = "M-20 0 h40 a20 20 0 0 1 0 40 h-40 z"  # a rectangle with a half disc of radius 20 at its right
AREA = 40 * 40 + math.pi * 20**2 / 2


def report(*arguments):
    good(*arguments, "--report", path("report.json"), "--quiet")
    with open(path("report.json")) as stream:
        return json.load(stream)


def picture(name, content):
    return write_text(name, f'<svg xmlns="http://www.w3.org/2000/svg">{content}</svg>')


def test_area_of_a_drawing_ExactOracle():
    """Corners within the smooth rim are chosen by the lines: four of them."""
    four = "".join(f'<path d="{each}"/>' for each in ("M-20 0 H20", "M20 0 A20 20 0 0 1 20 40", "M20 40 H-20", "M-20 40 V0"))
    found = report("parameterize", picture("four.svg", f'<g transform="scale(0.5)">{four}</g>'), "--output", path("map.vtu"))
    assert found["verdict"] == "valid" and found["injective"] == "injective", found
    assert (found["outline_arcs"], found["outline_lines"], found["outline_curves"]) == (1, 3, 0), found
    assert abs(found["area"] - AREA / 4) < 1e-9 * AREA, found["area"]  # the arc is exact
    assert found["outline_distance"] < 1e-12 * 60, found


def test_one_closed_line_ExactOracle():
    """Two corners: the two longest sides are halved, where the rim is smooth, so no map is regular, which is said."""
    file = picture("stadium.svg", f'<path d="{STADIUM}"/>')
    found = report("parameterize", file, "--outline-tolerance", 0.001, "--output", path("map.vtu"))
    assert found["outline_corners"] == 2 and found["verdict"] != "valid", found
    assert abs(found["area"] - AREA) < 0.001 * 75 * 190, found["area"]  # tolerance times size times length
    said = knotwork_testing.run_program("parameterize", file, "--output", path("map.vtu")).stderr
    assert "has 2 corners" in said and "layout" in said, said


def test_formats_agree_PropertyOracle():
    corners = [(0, 0), (3, 0.5), (2.5, 2), (-0.5, 1.5)]
    points = [(a[0] + (b[0] - a[0]) * k / 20, a[1] + (b[1] - a[1]) * k / 20)
              for a, b in zip(corners, corners[1:] + corners[:1]) for k in range(20)] + corners[:1]
    one = write_text("one.csv", "x,y\n" + "".join("%.17g,%.17g\n" % point for point in points))
    four = write_text("four.csv", "x,y,z,Line\n" + "".join("%.17g,%.17g,0,%d\n" % (*points[i], side)
                                                          for side in range(4) for i in range(20 * side, 20 * side + 21)))
    drawing = picture("points.svg", "<polyline points='" + " ".join("%.17g,%.17g" % (x, -y) for x, y in points) + "'/>")
    good("convert", drawing, "--output", path("lines.vtp"))
    areas = [report("parameterize", file, "--output", path("map.vtu"))["area"] for file in (one, four, drawing, path("lines.vtp"))]
    exact = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, corners[1:] + corners[:1])) / 2
    assert all(abs(area - exact) < 1e-12 for area in areas), (areas, exact)


def test_refusals():
    for content, words in (('<path d="M0 0 H3 V2"/>', ["close it"]), ('<path d="M0 0 H"/>', ["command H", "character"]),
                           ('<path d="M0 0 H1 V1 Z M5 5 H6 V6 Z"/>', ["2 lines", "layout"]), ("<text>no</text>", ["no line"]),
                           ('<g transform="bend(1)"><path d="M0 0 H1"/></g>', ["bend(1)"])):
        file = picture("wrong.svg", content)
        refuse(["parameterize", file, "--output", "map.vtu"], "wrong.svg", *words)
    refuse(["parameterize", write_text("hill.csv", "0,0,0\n1,0,1\n1,1,0\n"), "--output", "map.vtu"], "hill.csv", "z =")


def test_polygons_as_meshes_of_solvers_ExactOracle():
    good("source", "--shape", "annulus-sector", "--output", path("plate.vtu"))
    for ending in (".msh", ".mesh"):
        good("tessellate", path("plate.vtu"), "--output", path("plate" + ending))
        found = report("validate", path("plate" + ending))
        assert found["verdict"] == "valid", found
        good("tessellate", path("plate.vtu"), "--output", path("plate.vtp"))
        mesh, polygons = knotwork.read(path("plate" + ending)), knotwork.read(path("plate.vtp"))
        assert mesh.GetNumberOfCells() == polygons.GetNumberOfCells() and mesh.GetNumberOfPoints() == polygons.GetNumberOfPoints()
        assert max(abs(a - b) for i in range(mesh.GetNumberOfPoints()) for a, b in zip(mesh.GetPoint(i), polygons.GetPoint(i))) == 0.0


knotwork_testing.main(globals())
