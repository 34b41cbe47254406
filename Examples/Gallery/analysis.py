# SPDX-License-Identifier: BSD-3-Clause
"""Poisson's equation and elasticity on splines.

1. a plate with a hole that is drawn along x: von Mises' stress, which is three times as large at the hole as far from it;
2. a heat source like a peak, on a square whose elements are split where the estimated error is large;
3. that error by functions, against uniform refinement.

usage: analysis.py [--output DIR]
"""
import os

import knotwork
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkActor, vtkDataSetMapper

import _cases as cases
import _scene as scene

PLATE = """{ "material": { "youngs_modulus": 210000, "poissons_ratio": 0.3 }, "conditions": [
  { "on": { "where": "abs(x) < 1e-9" }, "displacement": [0, null] },
  { "on": { "where": "abs(y) < 1e-9" }, "displacement": [null, 0] },
  { "on": { "where": "nx > 0.99" }, "traction": [100, 0] } ] }"""
PEAK = """{ "source": "exp(-300 * ((x - 0.2)^2 + (y - 0.1)^2))", "conditions": [ { "on": "boundary", "value": 0 } ] }"""


def source(shape, degree, elements, **properties):
    made = knotwork.vtkSplineSource()
    made.SetShapeName(shape)
    made.SetDegree(degree)
    made.SetElements(elements, elements, 1)
    for name, value in properties.items():
        getattr(made, "Set" + name)(value)
    return made


def solved(body, equation, problem, **properties):
    analysis = knotwork.vtkSplineAnalysis()
    analysis.SetInputConnection(body.GetOutputPort())
    analysis.SetEquation(equation)
    analysis.SetProblem(problem)
    for name, value in properties.items():
        getattr(analysis, "Set" + name)(value)
    return scene.updated(analysis)


def coloured(grid, array, largest, title):
    """An actor of a spline's point array and the bar of its colours."""
    tessellate = knotwork.vtkSplineTessellate()
    tessellate.SetInputData(grid)
    scene.updated(tessellate)
    colours = vtkLookupTable()
    colours.SetHueRange(0.62, 0.0)
    colours.SetRange(0, largest)
    colours.Build()
    mapper = vtkDataSetMapper()
    mapper.SetInputConnection(tessellate.GetOutputPort())
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray(array)
    mapper.SetLookupTable(colours)
    mapper.UseLookupTableScalarRangeOn()
    item = vtkActor()
    item.SetMapper(mapper)
    item.GetProperty().LightingOff()
    bar = vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle(title)
    bar.SetNumberOfLabels(4)
    bar.SetLabelFormat("%-#6.3g")
    bar.SetPosition(0.83, 0.15)
    bar.SetWidth(0.1)
    bar.SetHeight(0.7)
    bar.UnconstrainedFontSizeOn()
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(*scene.INK)
        text.SetFontSize(16)
        text.ItalicOff()
        text.ShadowOff()
    return item, bar


def number(analysis, name):
    return analysis.GetOutputDataObject(3).GetValueByName(0, name).ToDouble()


def main():
    folder = scene.output_folder()
    plate = solved(source("QuarterPlateWithHole", 2, 12, InnerRadius=0.1), knotwork.vtkSplineAnalysis.ELASTICITY, PLATE)
    grid = plate.GetOutputDataObject(0)
    item, bar = coloured(grid, "VonMisesStress", 300, "MPa")
    title = f"plate drawn with 100 MPa: up to {number(plate, 'LargestVonMises'):.0f} MPa, imbalance {number(plate, 'Imbalance'):.0e}"
    panels = [scene.renderer([item, scene.actor(scene.element_edges(grid), scene.INK, 1, 0.4), bar,
                              scene.label(title, 0.03, 0.02, 18)], (0, 0, 0.34, 1), 0.82)]
    print(title)
    adaptive = solved(source("Square", 2, 8), knotwork.vtkSplineAnalysis.POISSON, PEAK, MaxSteps=11)
    grid = adaptive.GetOutputDataObject(0)
    item, bar = coloured(grid, "Solution", number(adaptive, "LargestValue"), "u")
    title = f"a peak of heat: {number(adaptive, 'Functions'):.0f} functions, error {number(adaptive, 'EstimatedError'):.1e}"
    print(title)
    panels.append(scene.renderer([item, scene.actor(scene.element_edges(grid), scene.INK, 1, 0.5), bar, scene.label(title, 0.03, 0.02, 18)],
                                 (0.34, 0, 0.68, 1), 0.82))
    uniform = [solved(source("Square", 2, 8 * 2 ** k), knotwork.vtkSplineAnalysis.POISSON, PEAK) for k in range(4)]
    history = adaptive.GetOutputDataObject(4)
    column = [[history.GetValueByName(row, name).ToDouble() for row in range(history.GetNumberOfRows())]
              for name in ("Functions", "EstimatedError")]
    series = [("adaptive", column[0], column[1], (5, True)),
              ("uniform", [number(u, "Functions") for u in uniform], [number(u, "EstimatedError") for u in uniform], (4, True))]
    cases.require(column[1][-1] < series[1][2][-2], "adaptive refinement needs more functions than uniform refinement")
    panels.append(cases.plot(series, (500, 560), (0.68, 0, 1, 1), ("functions", "estimated error"), log_y=True, legend=True))
    scene.save(panels, os.path.join(folder, "analysis.png"), (1600, 560))


if __name__ == "__main__":
    main()
