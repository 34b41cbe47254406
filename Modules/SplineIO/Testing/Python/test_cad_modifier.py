# SPDX-License-Identifier: BSD-3-Clause
"""The filter vtkCADModifier: a box cut, split, composed and mended, with the numbers that it must have."""
import os
import pathlib
import sys

from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkFiltersSources import vtkLineSource

import knotwork
import knotwork_testing

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "CommandLine/Testing"))
import step_solids  # noqa: E402


def path(name):
    return knotwork_testing.output("cad_modifier/" + name)


def box():
    """3 x 2 x 1; faces in the order y lower, x upper, y upper, x lower, bottom, top."""
    solids = step_solids.Solids()
    solids.box((0, 0, 0), (3, 2, 1), names=("", "", "", "", "", "Top"))
    return solids.write(path("box.step")) or path("box.step")


def modifier(operations, **properties):
    made = knotwork.vtkCADModifier()
    made.SetFileName(box())
    made.SetOperations(operations)
    for name, value in properties.items():
        getattr(made, "Set" + name)(value)
    return made


def row(made, index, *names):
    table = made.GetOutputDataObject(3)
    return [table.GetValueByName(index, name).ToString() for name in names]


def message(made):
    """The error of an update, which leaves nothing in the outputs."""
    messages = []
    made.AddObserver("ErrorEvent", lambda *_: messages.append(made.GetErrorCode()))
    made.Update()
    assert all(made.GetOutputDataObject(port).GetNumberOfCells() == 0 for port in range(3))
    return messages


def test_operations_in_their_order():
    kept = path("kept.step")
    if os.path.exists(kept):
        os.remove(kept)
    made = modifier("cut-plane 1 0 0 1 0 0;\n split-iso 0 u 0.5\ncomposite 0,2;", OutputFileName=kept)
    made.Update()
    table = made.GetOutputDataObject(3)
    assert table.GetNumberOfRows() == 3
    assert row(made, 0, "Operation", "SolidsBefore", "Solids", "Faces", "FaceIds") == ["cut-plane", "1", "2", "11", "12"]
    assert abs(table.GetValueByName(2, "Volume").ToDouble() - 6) < 1e-8
    assert len(row(made, 0, "NewFaces")[0].split(" ")) == 6 and row(made, 0, "NewFaces")[0].count(",") == 4
    assert os.path.exists(kept)
    # the outputs are those of the reader of what was kept
    reader = knotwork.vtkCADReader()
    reader.SetFileName(kept)
    reader.Update()
    for port in range(3):
        assert made.GetOutputDataObject(port).GetNumberOfCells() == reader.GetOutputDataObject(port).GetNumberOfCells() > 0
    assert made.GetOutputDataObject(2).GetCellData().GetArray("FaceId").GetRange()[1] == 12


def test_a_composite_is_in_the_grids():
    made = modifier("composite 4,1")
    made.Update()
    assert row(made, 0, "Composite") == ["1"]
    for port, cells in ((0, 6), (2, 12)):
        ids = made.GetOutputDataObject(port).GetCellData().GetArray("CompositeId")
        assert [ids.GetValue(i) for i in range(ids.GetNumberOfTuples())].count(0) == cells // 3, port
    # none: no array
    made.SetOperations("heal 0.001")
    made.Update()
    assert made.GetOutputDataObject(0).GetCellData().GetArray("CompositeId") is None
    assert row(made, 0, "TurnedFaces", "SewnEdges", "RemovedEdges", "Unmended") == ["0", "0", "0", ""]


def test_curves_come_by_the_input():
    points = vtkPoints()
    for point in ((1, -1, 5), (1, 3, 5)):
        points.InsertNextPoint(point)
    line = vtkLineSource()
    line.SetPoints(points)
    made = modifier("split-curve 5")
    assert message(made)
    made.SetInputConnection(line.GetOutputPort())
    made.Update()
    assert row(made, 0, "Faces", "Edges") == ["7", "15"]
    # a quarter of a circle around a corner of the box
    arc = knotwork.vtkSplineSource()
    arc.SetShape(knotwork.vtkSplineSource.ARC)
    arc.SetOuterRadius(1.0)
    arc.SetAngle(90.0)
    made.SetInputConnection(arc.GetOutputPort())
    made.Update()
    assert row(made, 0, "Faces", "Edges") == ["7", "15"]
    # another unit
    made = modifier("split-plane 5 0.1 0 0 1 0 0", Unit=knotwork.vtkCADModifier.Centimetre)
    made.Update()
    assert row(made, 0, "Faces") == ["7"]
    assert abs(made.GetOutputDataObject(3).GetValueByName(0, "Volume").ToDouble() - 6e-3) < 1e-11
    assert abs(made.GetOutputDataObject(2).GetBounds()[1] - 0.3) < 1e-9


def test_errors_leave_nothing():
    never = path("never.step")
    for operations in ("", "cut", "cut-plane 1 0 0 1 0", "composite 0", "imprint", "cut-plane 9 0 0 1 0 0"):
        assert message(modifier(operations, OutputFileName=never)), operations
        assert not os.path.exists(never)
    assert message(modifier("heal 0.1", OutputFileName=path("never.iges")))
    assert message(modifier("heal 0.1", FileName=path("missing.step")))
    assert message(knotwork.vtkCADModifier())


knotwork_testing.main(globals())
