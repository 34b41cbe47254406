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
    for name in os.listdir(FOLDER):
        os.remove(path(name))
    torus = simple.KnotworkSplineSource(Shape="Solid Torus", Angle=270, InnerRadius=0.4, OuterRadius=1)
    simple.SaveData(path("torus.vtu"), torus)
    square = simple.KnotworkSplineSource(Shape="Square", Degree=2, Elements=[5, 5, 1])
    folded = simple.Calculator(Input=square, CoordinateResults=1, Function="coords - (iHat + jHat)*1.1*((coordsX+0.5)*(coordsY+0.5))^3")
    simple.SaveData(path("folded.vtu"), folded)
    tube = simple.KnotworkSplineSource(Shape="Solid Tube", Angle=180, Height=1.5)
    simple.SaveData(path("tube.vtu"), tube)
    mesh = simple.SplineBoundary(Input=tube)
    simple.SaveData(path("tube.vtp"), mesh)
    scan = simple.Transform(Input=mesh)
    scan.Transform.Scale, scan.Transform.Rotate = [1.02, 0.99, 1.01], [0, 0, 1]
    simple.SaveData(path("scan.vtp"), scan)
    with open(path("hills.xyz"), "w", encoding="utf-8") as file:
        for i in range(41):
            for j in range(41):
                x, y = i / 10, j / 10
                file.write(f"{x} {y} {0.5 * ((x - 2) ** 2 * (y - 1) - (y - 2) ** 3) / 4:.6f}\n")
    plate = simple.KnotworkSplineSource(Shape="Quarter Plate With Hole", Degree=2, Elements=[8, 8, 1], Size=[4, 4, 1])
    simple.SaveData(path("plate.vtu"), plate)
    reset()


def say(text):
    """To the program's own output: the window shows what Python prints."""
    os.write(1, ("\n" + text).encode())


def reset():
    """An empty window for the next task."""
    simple.ResetSession()
    simple.GetActiveViewOrCreate("RenderView")


class Tasks:
    def __init__(self):
        self.window = Window()

    def open(self, name, reader=None):
        """File > Open, the reader where several offer themselves, Apply."""
        answers = [self.window.name_file(path(name))] + ([self.reader(reader)] if reader else [])
        self.window.in_dialogs(lambda: self.window.menu("File", "Open..."), *answers)
        self.window.apply()

    def reader(self, name):
        def answer(dialog):
            view = dialog.findChild(QtWidgets.QListWidget) or dialog.findChild(QtWidgets.QTableWidget)
            found = view.findItems(name, QtCore.Qt.MatchContains)
            assert found, f"no reader {name} among {[each.text() for each in view.findItems('', QtCore.Qt.MatchContains)]}"
            view.setCurrentItem(found[0])
            self.window.ok(dialog)
        return answer

    def save(self, name, kind):
        """File > Save Data, the format, OK to its options."""
        self.window.in_dialogs(lambda: self.window.menu("File", "Save Data..."), self.window.name_file(path(name), kind), self.window.ok)
        self.window.until(name, lambda: os.path.exists(path(name)))

    def filter(self, name):
        self.window.menu("Filters", "Knotwork", name)

    def opened_spline(self):
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
        self.save("tube.step", "STEP")
        reset()
        self.open("tube.step")

    def fitted_points(self):
        self.open("hills.xyz", "Point Cloud Reader")
        self.filter("Spline Surface Fit")
        self.window.apply()

    def contours(self):
        self.fitted_points()
        self.filter("Spline Contour")
        self.window.apply()

    def deviations(self):
        self.open("tube.vtu")
        self.open("scan.vtp")
        self.window.in_dialogs(lambda: self.filter("Deviation Map"), self.pick_model)
        self.window.apply()
        self.window.menu("Knotwork", "Color By Deviation")

    def pick_model(self, dialog):
        """The model, in the dialog that asks for all inputs; the scan was selected."""
        next(each for each in dialog.findChildren(QtWidgets.QRadioButton) if each.text() == "Model").click()
        self.window.wait(0.3)
        self.window.row(dialog.findChild(QtWidgets.QAbstractScrollArea, "pipelineView"), 0)
        dialog.grab().save(path("dialog.png"))
        self.window.ok(dialog)

    def warped_plate(self):
        self.open("plate.vtu")
        self.filter("Spline Analysis")
        self.window.choose("Equation", "Elasticity")
        self.window.write("Problem", PROBLEM)
        self.window.apply()
        self.window.menu("Knotwork", "Warp By Displacement")

    def example(self):
        self.window.menu("Knotwork", "Examples", "Fit and contours")
        self.window.wait(1)


    # what the window shows, beside the tasks

    def check_menus(self):
        for group, number in (("Sources", 4), ("Filters", 40)):
            entries = self.window.entries(group, "Knotwork")
            assert len(entries) == number, (group, len(entries))
            assert not any(each.icon().isNull() for each in entries), group
        bar = self.window.main.findChild(QtWidgets.QToolBar, "Knotwork")
        assert bar.isVisible() and len(bar.actions()) == 16, len(bar.actions())
        assert len(self.window.entries("Knotwork", "Examples")) == 4

    def check_examples(self):
        for each in [entry.text() for entry in self.window.entries("Knotwork", "Examples")]:
            self.window.menu("Knotwork", "Examples", each)
            self.window.wait(0.5)
            shown = [source for source in simple.GetSources().values()
                     if simple.GetDisplayProperties(source, simple.GetActiveView()).Visibility]
            assert shown, each

    def check_panels(self):
        """No option of another method, names of all numbers, frames."""
        self.window.menu("Sources", "Knotwork", "Knotwork Spline Source")
        for shape, has, has_not in (("Square", "Size", "Twist"), ("Twisted Bar", "Twist", "OuterRadius"), ("Torus Surface", "OuterRadius", "Size")):
            self.window.choose("Shape", shape)
            assert self.window.shows(has) and not self.window.shows(has_not), shape
        self.window.choose("Shape", "Square")
        self.window.apply()
        self.filter("Spline Refine")
        for mode, has, has_not in (("Uniform", "NumberOfRefinements", "Selection"), ("Selection", "Selection", "ImplicitFunction"),
                                   ("Implicit Function", "ImplicitFunction", "Selection")):
            self.window.choose("Mode", mode)
            assert self.window.shows(has) and not self.window.shows(has_not), mode

    def check_help(self):
        self.window.menu("Sources", "Knotwork", "Knotwork Spline Source")
        self.window.question_mark()
        pages = [each for each in self.window.app.topLevelWidgets() if each.metaObject().className() == "pqHelpWindow" and each.isVisible()]
        assert pages and "ready-made" in pages[0].findChild(QtWidgets.QTextBrowser).toPlainText(), pages
        pages[0].close()


NAMES = ["opened_spline", "folded_cells", "selected_cells", "analytic_model", "saved_step", "fitted_points", "contours", "deviations",
         "warped_plate", "example", "check_menus", "check_examples", "check_panels", "check_help"]


def main():
    failed = 0
    try:
        make_data()
        tasks = Tasks()
        for name in os.environ.get("KNOTWORK_WINDOW_TASKS", " ".join(NAMES)).split():
            try:
                getattr(tasks, name)()
                if not name.startswith("check_"):
                    tasks.window.picture(path(f"Window_{name}.png"), tasks.window.view())
                tasks.window.picture(path(f"whole_{name}.png"))
                say(f"done {name}\n")
            except BaseException:
                failed += 1
                say(traceback.format_exc())
                tasks.window.picture(path(f"failed_{name}.png"))
            reset()
    except BaseException:
        failed += 1
        say(traceback.format_exc())
    os._exit(1 if failed else 0)


QtCore.QTimer.singleShot(1500, main)
QtCore.QTimer.singleShot(500_000, lambda: os._exit(3))  # whatever hangs
