# SPDX-License-Identifier: BSD-3-Clause
"""usage: pvbatch make_states.py PLUGIN FOLDER: the example states of the menu Knotwork > Examples, with the data that they read.

States name their data without a folder: the menu and File > Load State look for it beside them."""
import os
import re
import sys

from paraview import servermanager, simple

PLUGIN, FOLDER = sys.argv[1:]
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
    view.CameraPosition, view.CameraViewUp = [6, -6, 7], [0, 0, 1]


def refined_disc(view):
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


def main():
    for make in (folded_cells, fit_and_contours, refined_disc, stress_and_displacement):
        view = simple.CreateRenderView()
        view.ViewSize = [640, 480]
        make(view)
        simple.Render(view)
        simple.ResetCamera(view)
        file = os.path.join(FOLDER, make.__name__.replace("_", " ").title().replace(" ", "_").replace("And", "and") + ".pvsm")
        simple.SaveState(file)
        simple.SaveScreenshot(file[:-5] + ".png", view)
        with open(file, encoding="utf-8") as stream:
            text = stream.read()
        text = re.sub(r'value="[^"]*/(hills\.xyz)"', r'value="\1"', text)
        text = re.sub(r"<Domain\b[^>]*/>|<Domain\b.*?</Domain>", "", text, flags=re.S)  # what a value may be is not read again
        with open(file, "w", encoding="utf-8") as stream:
            stream.write(re.sub(r"\n\s+", "\n", text))
        print(file)
        for proxy in [*simple.GetSources().values(), view]:
            simple.Delete(proxy)
        servermanager.ProxyManager().UnRegisterProxies()


main()
