# SPDX-License-Identifier: BSD-3-Clause
"""What is read wrongly is refused with its place; what is left out is named, in the report too, and is exit status 5."""
import json
import os

import numpy as np

import knotwork_testing
from refusals import good, path, refuse, write_bytes, write_text

CURVES = """<?xml version="1.0"?>
<xml>
 <PlanarDomain id="0"><CurveLoop index="0">
%s </CurveLoop></PlanarDomain>
%s</xml>
"""
SIDE = """  <Geometry type="BSpline" id="%s"><Basis type="BSplineBasis"><KnotVector degree="2">0 0 0 1/3 2/3 1 1 1</KnotVector></Basis>
   <coefs geoDim="2">%s</coefs></Geometry>
"""


def side(number, begin, end):
    """A straight curve: coefficients at the Greville points."""
    shares = np.array([0, 1 / 6, 1 / 2, 5 / 6, 1])[:, None]
    points = (1 - shares) * np.array(begin) + shares * np.array(end)
    return SIDE % (number, " ".join(map(repr, points.ravel().tolist())))


def square(rest=""):
    corners = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]
    return CURVES % ("".join(side("" if i == 2 else i, corners[i], corners[i + 1]) for i in range(4)), rest)


def status_of(*arguments):
    report = path("left_out.json")
    if os.path.exists(report):
        os.remove(report)
    done = knotwork_testing.run_program(*arguments, "--report", report)
    with open(report) as stream:
        return done.returncode, done.stderr, json.load(stream)["left_out"]


def test_curves_of_a_planar_domain_are_read():
    file = write_text("domain.xml", square())
    status, text, left_out = status_of("info", file)
    assert (status, text, left_out) == (0, "", []), (status, text, left_out)
    report = path("domain.json")
    good("info", file, "--report", report)
    with open(report) as stream:
        numbers = json.load(stream)
    assert numbers["patches"] == 4 and numbers["functions"] == 20 and numbers["parametric_dimension"] == 1, numbers


def test_what_is_left_out_is_named_and_is_status_5():
    file = write_text("mixed.xml", square(' <Geometry type="Torus" id="9"/>\n <Mesh type="off">OFF</Mesh>\n'))
    cloud = write_text("cloud.g2", "400 1 0 0\n2\n0 0 0\n1 0 0\n100 1 0 0\n3 0\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n")
    mesh = write_text("edges.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nelement edge 1\n"
                      "property int vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n0 1\n")
    cases = [(["info", file], ["'Torus'", "<Mesh>"]), (["convert", file, "--output", path("out.vtu")], ["'Torus'", "<Mesh>"]),
             (["info", cloud], ["1 splines"]), (["convert", cloud, "--output", path("out.vtp")], ["1 splines"]),
             (["flatten", mesh, "--output", path("out.vtp")], ["'edge'"])]
    for arguments, words in cases:
        status, text, left_out = status_of(*arguments)
        assert status == 5 and len(left_out) == len(words), (arguments, status, text, left_out)
        for word, part in zip(words, left_out):
            assert word in part and word in text and os.path.basename(arguments[1]) in part, (arguments, text, left_out)
        assert knotwork_testing.run_program(*arguments, "--quiet").stderr == ""
    assert "5 done" in knotwork_testing.run_program("--help").stdout


def test_numbers_that_are_none_are_refused_with_their_line():
    obj = "v 0 0 0\nv 1 0 0\nv %s 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
    for word in ("inf", "nan", "abc", "1e309"):
        refuse(["flatten", write_text("bad.obj", obj % word), "--output", "out.vtp"], "bad.obj", "line 3", word)
        stl = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 %s\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"
        refuse(["convert", write_text("bad.stl", stl % word), "--output", "out.vtp"], "bad.stl", "line 5", word)
        off = "OFF\n3 1 0\n0 0 0\n1 0 %s\n0 1 0\n3 0 1 2\n"
        refuse(["convert", write_text("bad.off", off % word), "--output", "out.vtp"], "bad.off", "line 4", word)
    off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    for part, other, line in (("3 1 0", "3 0junk 0", "line 2"), ("3 0 1 2", "3 0 1 2.9x", "line 6"),
                              ("3 0 1 2\n", "3 0 1 2\n3 2 1 0\n", "line 7"), ("3 0 1 2", "2 0 1", "line 6")):
        refuse(["flatten", write_text("spoiled.off", off.replace(part, other)), "--output", "out.vtp"], "spoiled.off", line)
    refuse(["fit", write_text("first.xyz", "1x 2 3\n" + "0 0 0\n1 0 0\n0 1 0\n1 1 0\n" * 9), "--output", "out.vtu"],
           "first.xyz", "line 1", "'1x'")
    binary = np.zeros(1, dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    binary["corners"][0] = [[0, 0, 0], [1, 0, 0], [0, np.nan, 0]]
    content = b" " * 80 + (1).to_bytes(4, "little") + binary.tobytes()
    refuse(["convert", write_bytes("binary.stl", content), "--output", "out.vtp"], "binary.stl", "facet 0")


def test_whole_numbers_are_decimal():
    for word in ("010", "0x10", "-01"):
        done = knotwork_testing.run_program("source", "--elements", word, 4, 1, "--output", path("never.vtu"))
        assert done.returncode == 2 and word in done.stderr, (word, done.returncode, done.stderr)
    good("source", "--elements", 10, 4, 1, "--output", path("ten.vtu"))


def polydata(points, polygons, name):
    """VTK's own writer crashes on a face of two corners."""
    def numbers(values, kind, label, components=1):
        text = " ".join(map(str, np.ravel(values)))
        return f'<DataArray type="{kind}" Name="{label}" NumberOfComponents="{components}" format="ascii">{text}</DataArray>'

    cells = numbers(np.concatenate(polygons), "Int64", "connectivity") + \
        numbers(np.cumsum([len(polygon) for polygon in polygons]), "Int64", "offsets")
    return write_text(name, '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64"><PolyData>'
                      f'<Piece NumberOfPoints="{len(points)}" NumberOfPolys="{len(polygons)}">'
                      f'<Points>{numbers(points, "Float64", "Points", 3)}</Points><Polys>{cells}</Polys>'
                      '</Piece></PolyData></VTKFile>\n')


def test_points_that_are_not_finite_and_faces_of_two_corners_are_refused():
    triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    two = polydata(triangle, [[0, 1, 2], [0, 1]], "two.vtp")
    holed = polydata([[0, 0, 0], [1, np.nan, 0], [0, 1, 0]], [[0, 1, 2]], "holed.vtp")
    for arguments in (["flatten", "--output", "out.vtp"], ["trim", "--output", "out.step"], ["convert", "--output", "out.xyz"]):
        refuse(arguments[:1] + [two] + arguments[1:], "two.vtp", "cell 1 is a polygon of 2 corners")
        refuse(arguments[:1] + [holed] + arguments[1:], "holed.vtp", "point 1 has a coordinate y")


def test_splines_are_not_fitted_by_their_control_points():
    good("source", "--shape", "annulus-sector", "--elements", 4, 4, 1, "--output", path("spline.vtu"))
    good("convert", path("spline.vtu"), "--output", path("spline.xml"))
    good("convert", path("spline.vtu"), "--output", path("spline.step"))
    for name in ("spline.vtu", "spline.xml", "spline.step"):
        refuse(["fit", path(name), "--output", "out.vtu"], name, "control points", "tessellate")
        refuse(["distance", path(name), path("spline.vtu"), "--output", "out.vtu"], name, "control points")
    good("tessellate", path("spline.vtu"), "--output", path("points.vtp"))
    good("fit", path("points.vtp"), "--output", path("fitted.vtu"))


knotwork_testing.main(globals())
