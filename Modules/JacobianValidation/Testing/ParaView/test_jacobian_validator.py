# SPDX-License-Identifier: BSD-3-Clause
"""The validator's output as ParaView draws it when nothing is chosen: invalid cells red, undecided ones amber."""
import os
import shutil

import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import (  # noqa: E402
    ColorBy, CreateRenderView, Delete, JacobianValidator, OutputPort, Show, XMLUnstructuredGridReader)
from vtkmodules.vtkCommonCore import vtkIntArray, vtkPoints  # noqa: E402
from vtkmodules.vtkCommonDataModel import (  # noqa: E402
    VTK_BEZIER_QUADRILATERAL, vtkBezierQuadrilateral, vtkUnstructuredGrid)
from vtkmodules.vtkIOImage import vtkPNGReader  # noqa: E402
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter  # noqa: E402

# Three bicubic cells side by side, x = their left end + (the curve of these control points), y = v. The derivative of
# the last has the Bernstein coefficients 2, -1.4, 1: positive (1.4^2 < 2), but it takes some subdivision to see it.
VALID = (0, 1 / 3, 2 / 3, 1)
FOLDED = (0.3, 0, 2 / 3, 1)
OPEN = (0, 1, 0.3, 0.8)


def grid():
    cell = vtkBezierQuadrilateral()
    cell.SetOrder(3, 3)
    made, points, count = vtkUnstructuredGrid(), vtkPoints(), vtkIntArray()
    points.SetDataTypeToDouble()
    points.SetNumberOfPoints(48)
    count.SetName("Count")  # scalars of the input's points: they would be drawn without the validator
    for k, curve in enumerate((VALID, FOLDED, OPEN)):
        for i in range(4):
            for j in range(4):
                points.SetPoint(16 * k + cell.PointIndexFromIJK(i, j, 0), 1.2 * k + curve[i], j / 3, 0)
        made.InsertNextCell(VTK_BEZIER_QUADRILATERAL, 16, range(16 * k, 16 * k + 16))
    for point in range(48):
        count.InsertNextValue(point)
    made.SetPoints(points)
    made.GetPointData().SetScalars(count)
    return made


def grid_file():
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid())
    writer.SetDataModeToBinary()
    writer.SetFileName(knotwork_testing.output("ParaViewVerdicts.vtu"))
    assert writer.Write() == 1
    return writer.GetFileName()


def draw(proxy, before_picture=lambda display: None):
    view = CreateRenderView()
    view.CameraPosition, view.CameraFocalPoint = [1.6, 0.5, 5], [1.6, 0.5, 0]
    view.CameraParallelProjection, view.CameraParallelScale = 1, 1.7
    before_picture(Show(proxy, view))
    return view


def shares(name):
    """How much of a picture is red, amber, and light grey or blue."""
    reader = vtkPNGReader()
    reader.SetFileName(knotwork_testing.output(name + ".png"))
    reader.Update()
    scalars = reader.GetOutput().GetPointData().GetScalars()
    counts = [0, 0, 0]
    for i in range(scalars.GetNumberOfTuples()):
        red, green, blue = (scalars.GetComponent(i, c) for c in range(3))
        counts[0] += red > 2.5 * max(green, blue)
        counts[1] += red > 1.2 * green and green > 2.5 * blue
        counts[2] += blue < 240 and 0.75 * blue < red <= green <= blue
    return [count / scalars.GetNumberOfTuples() for count in counts]


def fails(comparison, *arguments):
    try:
        comparison(*arguments)
    except AssertionError:
        return True
    return False


def check(view, name):
    knotwork_testing.save_and_compare(view, name)
    for share in shares(name):
        assert 0.05 < share < 0.12, shares(name)  # each cell is 1 / 3.4^2 = 0.087 of the picture, or a little less


def test_colours_by_default():
    validator = JacobianValidator(Input=XMLUnstructuredGridReader(FileName=[grid_file()]), MaximumBoxes=1)
    validator.UpdatePipeline()
    verdicts = validator.GetClientSideObject().GetOutputDataObject(0).GetCellData().GetArray("JacobianVerdict")
    assert [verdicts.GetValue(i) for i in range(3)] == [1, -1, 0]
    view = draw(OutputPort(validator, 0))
    check(view, "ParaViewVerdicts")
    Delete(view)


def test_colours_of_an_annotated_file():
    name = knotwork_testing.output("ParaViewVerdictsAnnotated.vtu")
    done = knotwork_testing.run_program("validate", grid_file(), "--output", name, "--maximum-boxes", 1)
    assert done.returncode == 3, done.stderr
    view = draw(XMLUnstructuredGridReader(FileName=[name]))
    check(view, "ParaViewVerdicts")
    Delete(view)


def test_other_colours_are_noticed():
    validator = JacobianValidator(Input=XMLUnstructuredGridReader(FileName=[grid_file()]), MaximumBoxes=1)
    baseline = knotwork_testing.BASELINE_DIR
    expected = os.path.join(baseline, "ParaViewVerdicts.png")
    knotwork_testing.BASELINE_DIR = os.path.dirname(knotwork_testing.output("ParaViewWrong/x"))
    try:
        shutil.copy(expected, os.path.join(knotwork_testing.BASELINE_DIR, "ParaViewVerdictsWrong.png"))
        for colour in (None, ("CELLS", "JacobianMinLower"), ("POINTS", "Count")):
            view = draw(OutputPort(validator, 0), lambda display: ColorBy(display, colour))
            assert fails(check, view, "ParaViewVerdictsWrong"), colour
            Delete(view)
    finally:
        knotwork_testing.BASELINE_DIR = baseline


knotwork_testing.main(globals())
