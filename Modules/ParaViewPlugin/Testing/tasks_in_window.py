# SPDX-License-Identifier: BSD-3-Clause
"""What test_window.py runs in ParaView's window: ten tasks, each an input, Apply and Save, and a picture of the view behind it.

usage: paraview --script tasks_in_window.py, with the folder of data and pictures in KNOTWORK_WINDOW."""
import os
import sys
import traceback

from PyQt5 import QtCore, QtWidgets

sys.path.insert(0, os.path.dirname(os.path.abspath(os.environ["KNOTWORK_WINDOW_SCRIPTS"] + "/x")))
import paraview.simple as simple  # noqa: E402
from window import Window  # noqa: E402

FOLDER = os.environ["KNOTWORK_WINDOW"]
PROBLEM = """{ "material": { "youngs_modulus": 1000, "poissons_ratio": 0.3 }, "conditions": [
  { "on": { "where": "abs(x) < 1e-9" }, "displacement": [0, null] },
  { "on": { "where": "abs(y) < 1e-9" }, "displacement": [null, 0] },
  { "on": { "where": "nx > 0.99" }, "traction": [1, 0] } ] }"""


def path(name):
    return os.path.join(FOLDER, name)


def make_data():
    """Files that the tasks open; no part of a task."""
    torus = simple.KnotworkSplineSource(Shape="Solid Torus", Angle=270, InnerRadius=0.4, OuterRadius=1)
    simple.SaveData(path("torus.vtu"), torus)
    square = simple.KnotworkSplineSource(Shape="Square", Degree=2, Elements=[5, 5, 1])
    folded = simple.Calculator(Input=square, CoordinateResults=1, Function="coords - (iHat + jHat)*1.1*((coordsX+0.5)*(coordsY+0.5))^3")
    simple.SaveData(path("folded.vtu"), folded)
    tube = simple.KnotworkSplineSource(Shape="Solid Tube", Angle=180, Height=1.5)
    simple.SaveData(path("tube.vtu"), tube)
    mesh = simple.SplineBoundary(Input=tube)
    simple.SaveData(path("tube.vtp"), mesh)
    scan = simple.Calculator(Input=mesh, CoordinateResults=1, Function="coords*(1+0.02*sin(7*coordsX)*cos(5*coordsZ))")
    simple.SaveData(path("scan.vtp"), scan)
    with open(path("hills.xyz"), "w", encoding="utf-8") as file:
        for i in range(41):
            for j in range(41):
                x, y = i / 10, j / 10
                file.write(f"{x} {y} {0.5 * ((x - 2) ** 2 * (y - 1) - (y - 2) ** 3) / 4:.6f}\n")
    plate = simple.KnotworkSplineSource(Shape="Quarter Plate With Hole", Degree=2, Elements=[8, 8, 1], Size=[4, 4, 1])
    simple.SaveData(path("plate.vtu"), plate)
    simple.ResetSession()


class Tasks:
    def __init__(self):
        self.window = Window()

    def open(self, name, reader=None):
        """File > Open, Apply."""
        def trigger():
            self.window.menu("File", "Open...")
        self.window.in_dialog(self.window.name_file(path(name)), trigger)
        if reader:
            self.window.in_dialog(lambda dialog: self.pick_reader(dialog, reader), lambda: None)
        self.window.apply()

    def pick_reader(self, dialog, reader):
        tree = dialog.findChild(QtWidgets.QListWidget)
        items = tree.findItems(reader, QtCore.Qt.MatchContains)
        tree.setCurrentItem(items[0])
        return self.window.ok(dialog)

    def save(self, name, kind):
        """File > Save Data, the format, OK to what it asks."""
        self.window.in_dialog(self.window.name_file(path(name), kind), lambda: QtCore.QTimer.singleShot(
            0, lambda: self.window.menu("File", "Save Data...")))
        self.window.in_dialog(self.window.ok, lambda: None)
        self.window.until(name, lambda: os.path.exists(path(name)))

    def filter(self, name):
        self.window.menu("Filters", "Knotwork", name)

    def opened_spline_is_smooth(self):
        self.open("torus.vtu")

    def folded_cells(self):
        self.open("folded.vtu")
        self.filter("Jacobian Validator")
        self.window.apply()

    def selected_cells(self):
        self.folded_cells()
        self.window.menu("Knotwork", "Select Invalid Cells")

    def analytic_model(self):
        self.open("tube.vtp")
        self.filter("Analytic Model")
        self.window.apply()

    def saved_step(self):
        self.analytic_model()
        self.window.select(3)
        self.save("tube.step", "STEP")
        simple.ResetSession()
        self.open("tube.step")

    def fitted_points(self):
        self.open("hills.xyz", "Knotwork")
        self.filter("Spline Surface Fit")
        self.window.apply()

    def contours(self):
        self.fitted_points()
        self.filter("Spline Contour")
        self.window.apply()

    def deviations(self):
        self.open("tube.vtu")
        self.open("scan.vtp")
        self.window.in_dialog(self.pick_model, lambda: self.filter("Deviation Map"))
        self.window.apply()
        self.window.menu("Knotwork", "Color By Deviation")

    def pick_model(self, dialog):
        """The model, in the dialog that asks for all inputs; the scan was selected."""
        next(each for each in dialog.findChildren(QtWidgets.QRadioButton) if each.text() == "Model").click()
        self.window.wait(0.3)
        self.window.row(dialog.findChild(QtWidgets.QAbstractScrollArea, "pipelineView"), 1)
        self.window.picture(path("dialog.png"), dialog)
        return self.window.ok(dialog)

    def warped_plate(self):
        self.open("plate.vtu")
        self.filter("Spline Analysis")
        self.window.choose("Equation", "Elasticity")
        self.window.write("Problem", PROBLEM)
        self.window.apply()
        self.window.menu("Knotwork", "Warp By Displacement")

    def example(self):
        self.window.menu("Knotwork", "Examples", self.window.entries("Knotwork", "Examples")[0].text())
        self.window.wait(1)


NAMES = ["opened_spline_is_smooth", "folded_cells", "selected_cells", "analytic_model", "saved_step", "fitted_points", "contours", "deviations",
         "warped_plate", "example"]


def main():
    failed = 0
    try:
        make_data()
        tasks = Tasks()
        for name in os.environ.get("KNOTWORK_WINDOW_TASKS", " ".join(NAMES)).split():
            try:
                getattr(tasks, name)()
                tasks.window.picture(path(f"Window_{name}.png"), tasks.window.view())
                tasks.window.picture(path(f"whole_{name}.png"))
                print("done", name, flush=True)
            except BaseException:
                failed += 1
                traceback.print_exc()
                tasks.window.picture(path(f"failed_{name}.png"))
            simple.ResetSession()
    except BaseException:
        failed += 1
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(1 if failed else 0)


QtCore.QTimer.singleShot(1500, main)
