# SPDX-License-Identifier: BSD-3-Clause
"""usage: pvbatch make_states.py PLUGIN FOLDER: the example states of the menu Knotwork > Examples, with the data that they read.

States name their data without a folder: the menu and File > Load State look for it beside them."""
import os
import re
import subprocess
import sys

from paraview import simple

PLUGIN, FOLDER, *NAME = sys.argv[1:]
simple.LoadPlugin(PLUGIN, remote=False, ns=simple.__dict__)
PROBLEM = """{ "material": { "youngs_modulus": 1000, "poissons_ratio": 0.3 },
  "conditions": [
    { "on": { "where": "abs(x) < 1e-9" }, "displacement": [0, null] },
    { "on": { "where": "abs(y) < 1e-9" }, "displacement": [null, 0] },
    { "on": { "where": "nx > 0.99" }, "traction": [1, 0] } ] }"""


def folded_cells(view):
    square = simple.KnotworkSplineSource(Shape="Square", Degree=2, Elements=[5, 5, 1])
    folded = simple.Calculator(Input=square, CoordinateResults=1,
                               Function="coords - (iHat + jHat)*1.1*((coordsX+0.5)*(coordsY+0.5))^3")
    show(simple.JacobianValidator(Input=folded), view, ("CELLS", "JacobianVerdict"), "Surface With Edges")


def stress_and_displacement(view):
    plate = simple.KnotworkSplineSource(Shape="Quarter Plate With Hole", Degree=2, Elements=[8, 8, 1], Size=[4, 4, 1])
    solved = simple.SplineAnalysis(Input=plate, Equation="Elasticity", Problem=PROBLEM)
    show(simple.WarpByVector(Input=solved, Vectors=["POINTS", "Displacement"], ScaleFactor=50), view, ("POINTS", "VonMisesStress"))


def fit_and_contours(view):
    with open(os.path.join(FOLDER, "hills.xyz"), "w", encoding="utf-8") as file:
        for i in range(21):
            for j in range(21):
                x, y = i / 5, j / 5
                file.write(f"{x} {y} {0.5 * ((x - 2) ** 2 * (y - 1) - (y - 2) ** 3) / 4:.4f}\n")
    points = simple.PointCloudReader(FileName=os.path.join(FOLDER, "hills.xyz"))
    surface = simple.SplineSurfaceFit(Input=points, Tolerance=0.01)
    show(surface, view, None)
    contours = show(simple.SplineContour(Input=surface), view, ("CELLS", "Level"))
    contours.LineWidth = 3
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [8, -4, 7], [2, 2, 0], [0, 0, 1]


def refined_annulus(view):
    disc = simple.KnotworkSplineSource(Shape="Annulus Sector", Degree=2, Elements=[4, 8, 1], Angle=180)
    refined = simple.SplineRefine(Input=disc, Mode="Implicit Function", NumberOfRefinements=2)
    refined.ImplicitFunction = "Sphere"
    refined.ImplicitFunction.Center, refined.ImplicitFunction.Radius = [0, 1, 0], 0.3
    show(refined, view, ("CELLS", "Level"), "Surface With Edges")
    net = show(simple.SplineControlNet(Input=refined), view, None)
    net.DiffuseColor = net.AmbientColor = [0.75, 0.1, 0.15]


def show(proxy, view, array, representation="Surface"):
    shown = simple.Show(proxy, view)
    shown.SetRepresentationType(representation)
    if array:
        simple.ColorBy(shown, array)
        shown.SetScalarBarVisibility(view, True)
    return shown


def save(make):
    view = simple.GetActiveViewOrCreate("RenderView")
    make(view)
    simple.Render(view)
    simple.ResetCamera(view)
    file = os.path.join(FOLDER, make.__name__.capitalize() + ".pvsm")
    simple.SaveState(file)
    simple.SaveScreenshot(file[:-len("pvsm")] + "png", view, ImageResolution=[640, 480])
    with open(file, encoding="utf-8") as stream:
        text = stream.read()
    text = re.sub(r'value="[^"]*/(hills\.xyz)"', r'value="\1"', text)
    text = re.sub(r"<Domain\b[^>]*/>|<Domain\b.*?</Domain>", "", text, flags=re.S)  # what a value may be is not read again
    with open(file, "w", encoding="utf-8") as stream:
        stream.write(re.sub(r"\n\s+", "\n", text))
    print(file)


STATES = (fit_and_contours, folded_cells, refined_annulus, stress_and_displacement)
if NAME:
    save(next(each for each in STATES if each.__name__ == NAME[0]))
else:  # each in a window of its own
    for each in STATES:
        subprocess.run(["pvbatch", __file__, PLUGIN, FOLDER, each.__name__], check=True)
