# SPDX-License-Identifier: BSD-3-Clause
"""Splines fitted to shapes: from files to files by the job, and with an implicit function."""
import json
import math
import os
import subprocess

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.vtkCommonDataModel import vtkSphere
from vtkmodules.vtkFiltersSources import vtkSphereSource

FOLDER = os.path.dirname(knotwork_testing.output("cad_fit/files"))


def sphere_text(n, radius=1.0):
    """An equiangular cube-sphere."""
    numbers, faces = {}, []
    for axis in range(3):
        for end in (0, n):
            for i, j in np.ndindex(n, n):
                corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                keys = [tuple(np.roll((end, a, b), axis)) for a, b in (corners if end else corners[::-1])]
                faces.append([numbers.setdefault(key, len(numbers)) for key in keys])
    points = np.tan((2.0 * np.array(list(numbers)) / n - 1) * np.pi / 4)
    points *= radius / np.linalg.norm(points, axis=1)[:, None]
    return "\n".join([f"OFF\n{len(points)} {len(faces)} 0", *("%.17g %.17g %.17g" % tuple(p) for p in points),
                      *("4 %d %d %d %d" % tuple(f) for f in faces)]) + "\n"


def write(name, text):
    with open(os.path.join(FOLDER, name), "w", encoding="utf-8") as file:
        file.write(text)
    return os.path.join(FOLDER, name)


def run(*words):
    done = subprocess.run([knotwork_testing.PROGRAM, *map(str, words)], cwd=FOLDER, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 0, (words, done.stderr)


def report(name="report.json"):
    with open(os.path.join(FOLDER, name), encoding="utf-8") as file:
        return json.load(file)


def write_sphere_scan():
    source = vtkSphereSource()
    source.SetRadius(1.0)
    source.SetThetaResolution(60)
    source.SetPhiResolution(60)
    source.SetLatLongTessellation(False)
    source.SetOutputPointsPrecision(1)
    source.Update()
    knotwork.write(source.GetOutput(), os.path.join(FOLDER, "scan.vtp"))


def test_defaults_and_refused_values():
    made = knotwork.vtkCADFit()
    assert (made.GetDegree(), made.GetPolicy(), made.GetTargetType(), made.GetSmoothing()) == (3, 0, 0, made.CERTIFICATE)
    assert (made.GetSharpAngle(), made.GetWeakAngle(), made.GetCornerAngle(), made.GetFaceGroups()) == (40, 20, 60, None)
    for name, value in (("Degree", 10), ("ExtraPoints", 17), ("SharpAngle", 0), ("Smoothing", "all"), ("Projections", 0)):
        try:
            getattr(made, "Set" + name)(value)
        except ValueError:
            continue
        raise AssertionError(name)


def test_implicit_function():
    made = knotwork.vtkCADFit()
    made.SetInputDataObject(knotwork.read(write("sphere.off", sphere_text(8, 1.02))))
    sphere = vtkSphere()
    sphere.SetRadius(1.0)
    made.SetTargetType(made.IMPLICIT_FUNCTION)
    made.SetImplicitFunction(sphere)
    made.Update()
    table = made.GetOutputDataObject(1)
    assert table.GetValueByName(0, "RmsDistance").ToDouble() < 2.6e-6
    assert abs(table.GetValueByName(0, "Volume").ToDouble() - 4 * math.pi / 3) < 1e-5
    assert table.GetValueByName(0, "Verdict").ToString() == "valid"
    sphere.SetRadius(1.1)  # the filter notices
    made.Update()
    assert abs(table.GetValueByName(0, "Volume").ToDouble() - 4 * math.pi / 3 * 1.331) < 1e-4


def test_scan_to_solid():
    write_sphere_scan()
    write("quads.off", sphere_text(6))
    run("cadfit", "quads.off", "--target", "scan.vtp", "--output", "solid.step", "--entities", "entities.csv", "--report", "report.json")
    numbers = report()
    assert numbers["verdict"] == "valid" and numbers["patches"] == 6 and numbers["path"] == "composite", numbers
    assert numbers["rms_distance"] < 0.25 * numbers["mesh_rms_distance"], numbers
    assert numbers["rms_distance_back"] < 0.25 * numbers["mesh_rms_distance_back"], numbers
    assert numbers["max_distance"] <= numbers["max_distance_bound"] <= 1.5 * numbers["max_distance"], numbers
    assert numbers["max_distance_back"] <= numbers["max_distance_back_bound"], numbers
    for key in ("functions", "elements", "max_distance", "max_distance_back", "min_jacobian_lower", "invalid_elements_before",
                "smoothed_elements", "unmatched_features", "volume", "seconds"):
        assert key in numbers, key
    # the solid is the target of the next fit
    run("cadfit", "quads.off", "--target", "solid.step", "--degree", 2, "--output", "again.vtu", "--unmatched", "unmatched.csv", "--report", "again.json")
    again = report("again.json")
    assert again["max_distance_bound"] == -1.0  # of triangles alone
    assert again["rms_distance"] < 0.3 * again["mesh_rms_distance"] and again["unmatched_features"] == 0, again
    assert abs(again["volume"] - numbers["volume"]) < 1e-3 * numbers["volume"]


def test_paths():
    write_sphere_scan()
    write("quads.off", sphere_text(6))
    for path in ("automatic", "unstructured", "composite"):
        run("cadfit", "quads.off", "--target", "scan.vtp", "--path", path, "--output", "path.vtu", "--report", path + ".json")
    automatic, cells, patches = (report(path + ".json") for path in ("automatic", "unstructured", "composite"))
    assert (automatic["path"], cells["path"], patches["path"]) == ("composite", "unstructured", "composite")
    assert abs(cells["volume"] - patches["volume"]) < 1e-12 and "path_note" not in patches
    run("cadfit", "quads.off", "--target", "scan.vtp", "--path", "coons", "--composite-weights", "plain", "--output", "path.vtu",
        "--report", "coons.json")
    coons = report("coons.json")
    assert (coons["path"], coons["path_tried"]) == ("unstructured", "coons") and "lie on the target" in coons["path_note"], coons


knotwork_testing.main(globals())
