# SPDX-License-Identifier: BSD-3-Clause
"""Quadrilaterals swept to hexahedra, from files to files and in Python: volumes are known, `validate` and `cadfit` take the result."""
import json
import math
import os

import knotwork
import knotwork_testing
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

FOLDER = os.path.dirname(knotwork_testing.output("sweep/files"))


def square(n):
    """n x n quadrilaterals of [0, 1]^2."""
    lines = ["OFF", f"{(n + 1) ** 2} {n * n} 0"]
    lines += [f"{i / n} {j / n} 0" for j in range(n + 1) for i in range(n + 1)]
    lines += [f"4 {a} {a + 1} {a + n + 2} {a + n + 1}" for j in range(n) for a in range(j * (n + 1), j * (n + 1) + n)]
    name = os.path.join(FOLDER, "square.off")
    with open(name, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return name


def swept(*arguments):
    done = knotwork_testing.run_program("sweep", *arguments, "--output", "bar.vtu", "--report", "bar.json", "--force", folder=FOLDER)
    assert done.returncode == 0, done.stderr
    with open(os.path.join(FOLDER, "bar.json"), encoding="utf-8") as file:
        return json.load(file)


def test_a_twisted_bar_is_valid_and_becomes_a_spline():
    report = swept(square(4), "--direction", 0, 0, 4, "--layers", 16, "--twist", 90)
    assert (report["hexahedra"], report["points"], report["verdict"]) == (256, 425, "valid"), report
    assert 3.9 < report["volume"] < 4.0, report  # Cavalieri's 4 but for flat sides between layers
    done = knotwork_testing.run_program("validate", "bar.vtu", folder=FOLDER)
    assert done.returncode == 0, done.stderr
    done = knotwork_testing.run_program("cadfit", "bar.vtu", "--degree", 2, "--output", "spline.vtu", "--report", "spline.json", "--force", folder=FOLDER)
    assert done.returncode == 0, done.stderr
    with open(os.path.join(FOLDER, "spline.json"), encoding="utf-8") as file:
        spline = json.load(file)
    assert spline["verdict"] == "valid" and abs(spline["volume"] - 4.0) < abs(report["volume"] - 4.0), spline


def test_folded_hexahedra_are_warned_of():
    """A quarter turn about a line through the middle of the square."""
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(os.path.join(FOLDER, "turn.vtp"))
    writer.SetInputDataObject(surface([(0.5 + 0.2 * math.cos(a), 0.5, 0.2 * math.sin(a)) for a in (k * math.pi / 16 for k in range(17))],
                                      [list(range(17))], lines=True))
    writer.Write()
    done = knotwork_testing.run_program("sweep", square(4), "--path", "turn.vtp", "--output", "turn.vtu", "--force", folder=FOLDER)
    assert done.returncode == 0 and "hexahedra are folded, the first is cell" in done.stderr, done.stderr


def surface(points, cells, lines=False):
    data, places, ids = vtkPolyData(), vtkPoints(), vtkCellArray()
    for point in points:
        places.InsertNextPoint(point)
    for cell in cells:
        ids.InsertNextCell(len(cell), cell)
    data.SetPoints(places)
    (data.SetLines if lines else data.SetPolys)(ids)
    return data


def test_a_ring_in_python():
    """Pappus: the area times the way of its centre, but for the flat sides of 100 layers."""
    circle = [(5 * math.cos(2 * math.pi * k / 400), 0, 5 * math.sin(2 * math.pi * k / 400)) for k in range(400)]
    sweep = knotwork.vtkSweepToHexahedra()
    sweep.SetInputDataObject(surface([(4, -1, 0), (6, -1, 0), (6, 1, 0), (4, 1, 0)], [[0, 1, 2, 3]]))
    sweep.SetPathData(surface(circle, [[*range(400), 0]], lines=True))
    sweep.SetLayers(100)
    sweep.Update()
    numbers = sweep.GetOutputDataObject(1)
    assert numbers.GetValueByName(0, "Ring").ToInt() == 1 and numbers.GetValueByName(0, "ValidCells").ToInt() == 100
    volume = numbers.GetValueByName(0, "Volume").ToDouble()
    assert abs(volume / (4 * 2 * math.pi * 5) - 1) < 2 * (math.pi / 100) ** 2, volume


knotwork_testing.main(globals())
