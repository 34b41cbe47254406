# SPDX-License-Identifier: BSD-3-Clause
"""A boundary with waves before and after the optimization, coloured by det J, and how the optimization gets there.

usage: domain_quality.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

import _cases as cases
import _scene as scene
from certified_maps import filled, waves

SAMPLES = 401  # a direction
HIGHEST = 3.0  # of the colours


def colours():
    """Red where det J <= 0, then from yellow over green (det J = S, the mean) to blue."""
    stops = np.array([(0.0, 0.99, 0.91, 0.33), (1 / 3, 0.20, 0.72, 0.47), (2 / 3, 0.15, 0.40, 0.55),
                      (1.0, 0.20, 0.10, 0.35)])
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for i, t in enumerate(np.linspace(0, 1, 256)):
        table.SetTableValue(i, *(np.interp(t, stops[:, 0], stops[:, c]) for c in (1, 2, 3)), 1)
    table.SetRange(0, HIGHEST)
    table.SetBelowRangeColor(0.80, 0.15, 0.12, 1)
    table.UseBelowRangeColorOn()
    return table


def sampled(grid, area):
    """Points of a planar map of one patch with det J over the area, as quadrilaterals."""
    t = np.linspace(0, 1, SAMPLES)
    u, v = (x.ravel() for x in np.meshgrid(t, t))
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.c_[u, v, 0 * u], deep=1))
    parameters = vtkPolyData()
    parameters.SetPoints(points)
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputDataObject(0, grid)
    evaluate.SetInputDataObject(1, parameters)
    evaluate.SetDerivatives(1)
    found = scene.updated(evaluate).GetOutput()
    a, b = (vtk_to_numpy(found.GetPointData().GetArray("Derivative_" + name)) for name in "uv")
    det = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / area
    corner = (np.arange(SAMPLES - 1)[:, None] * SAMPLES + np.arange(SAMPLES - 1)).ravel()
    cells = vtkCellArray()
    for first in corner.tolist():
        cells.InsertNextCell(4, (first, first + 1, first + SAMPLES + 1, first + SAMPLES))
    result = vtkPolyData()
    raised = vtk_to_numpy(found.GetPoints().GetData()).astype(float)
    raised[:, 2] = np.where(det <= 0, 0.0008, 0)  # folds lie over what they cover
    shown = vtkPoints()
    shown.SetDataTypeToDouble()
    shown.SetData(numpy_to_vtk(raised, deep=1))
    result.SetPoints(shown)
    result.SetPolys(cells)
    result.GetPointData().SetScalars(numpy_to_vtk(det, deep=1))
    return result, det


def panel(grid, area, title, viewport):
    surface, det = sampled(grid, area)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.SetLookupTable(colours())
    mapper.UseLookupTableScalarRangeOn()
    mapper.InterpolateScalarsBeforeMappingOn()
    faces = vtkActor()
    faces.SetMapper(mapper)
    faces.GetProperty().SetLighting(False)
    edges = scene.actor(scene.element_edges(grid), scene.INK, 1)
    edges.SetPosition(0, 0, 0.0016)
    result = scene.renderer([faces, edges], viewport, 1.2)
    result.GetActiveCamera().SetWindowCenter(0, -0.08)  # room for the text
    text = scene.label(f"{title}: det J / S from {det.min():.2f} to {det.max():.2f}", 0.5, 0.02, 18)
    text.GetTextProperty().SetJustificationToCentered()
    result.AddActor(text)
    return result


def legend(viewport):
    bar = vtkScalarBarActor()
    bar.SetLookupTable(colours())
    bar.SetNumberOfLabels(4)
    bar.SetLabelFormat("%.0f")
    bar.SetDrawBelowRangeSwatch(True)
    bar.SetBelowRangeAnnotation("<= 0")
    bar.SetTitle("det J / S")
    bar.SetPosition(0.25, 0.15)
    bar.SetWidth(0.7)
    bar.SetHeight(0.75)
    bar.UnconstrainedFontSizeOn()
    for text, size in ((bar.GetTitleTextProperty(), 16), (bar.GetLabelTextProperty(), 14),
                       (bar.GetAnnotationTextProperty(), 14)):
        text.SetFontSize(size)
        text.SetColor(*scene.INK)
        text.BoldOff()
        text.ItalicOff()
        text.ShadowOff()
    result = scene.renderer([], viewport)
    result.AddActor(bar)
    return result


def energies(domain):
    """The quality functional after every iteration."""
    table = domain.GetOutputDataObject(2)
    rows = [i for i in range(table.GetNumberOfRows()) if table.GetValueByName(i, "Stage").ToString() == "quality"]
    return np.array([table.GetValueByName(i, "Energy").ToDouble() for i in rows])


def main():
    folder = scene.output_folder()
    runs = {}
    for name, optimizer in (("L-BFGS", 1), ("Newton", 2)):
        runs[name] = filled(folder, "waves", waves(), optimizer)
        if runs[name].GetVerdict() != 1:
            raise RuntimeError("the map of the waves is not proved valid")
    domain = runs["L-BFGS"]
    area = domain.GetOutputDataObject(0).GetFieldData().GetArray("Area").GetTuple1(0)
    scene.save([panel(domain.GetOutputDataObject(1), area, "Coons", (0, 0, 0.43, 1)),
                panel(domain.GetOutputDataObject(0), area, "optimized", (0.43, 0, 0.86, 1)),
                legend((0.86, 0, 1, 1))], os.path.join(folder, "domain_jacobian.png"), (1100, 500))

    histories = {name: energies(run) for name, run in runs.items()}
    least = min(history[-1] for history in histories.values())
    series = []
    for name, history in histories.items():
        gap = (history - least) / least
        keep = gap > 1e-9
        series.append((name, np.arange(len(history))[keep], gap[keep]))
    cases.chart(series, os.path.join(folder, "domain_convergence.png"), (700, 450), "iteration",
                "functional above its least value, relative")


if __name__ == "__main__":
    main()
