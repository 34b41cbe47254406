# SPDX-License-Identifier: BSD-3-Clause
"""Drives ParaView's window from inside, by `paraview --script`: menus, panels and dialogs as a user sees them.

Actions are triggered, buttons clicked and fields filled in; nothing is reached that the window does not show or that is grey. PyQt5 wraps the
widgets of the running program."""
import os

from PyQt5 import QtCore, QtWidgets
from PyQt5.QtTest import QTest

PATIENCE = 40  # seconds that a filter may take


def plain(text):
    return text.replace("&", "").split("\t")[0]


class Window:
    def __init__(self, size=(1000, 760)):
        self.app = QtWidgets.QApplication.instance()
        self.main = next(each for each in self.app.topLevelWidgets() if each.objectName() == "pqClientMainWindow")
        self.main.resize(*size)
        self.wait(0.5)

    def wait(self, seconds):
        QTest.qWait(int(1000 * seconds))

    def until(self, what, condition):
        for _ in range(10 * PATIENCE):
            found = condition()
            if found:
                return found
            self.wait(0.1)
        raise AssertionError(f"there is no {what} after {PATIENCE} s")

    def menu(self, *words):
        """Triggers the action at the end of a path of menus, which must not be grey."""
        menu = self.main.menuBar()
        for word in words[:-1]:
            menu = self.entry(menu, word).menu()
        action = self.entry(menu, words[-1])
        assert action.isEnabled(), f"{' > '.join(words)} is grey"
        action.trigger()
        self.wait(0.3)

    @staticmethod
    def entry(menu, word):
        for action in menu.actions():
            if plain(action.text()) == word:
                return action
        raise AssertionError(f"no {word} among {[plain(each.text()) for each in menu.actions()]}")

    def entries(self, *words):
        menu = self.main.menuBar()
        for word in words:
            menu = self.entry(menu, word).menu()
        return menu.actions()

    def child(self, kind, name=None, of=None, text=None):
        for each in (of or self.main).findChildren(kind):
            if each.isVisible() and (name is None or each.objectName() == name) and (text is None or plain(each.text()) == text):
                return each
        return None

    def click(self, button):
        assert button.isEnabled(), f"the button {button.text()} is grey"
        QTest.mouseClick(button, QtCore.Qt.LeftButton)
        self.wait(0.3)

    def panel(self):
        return next(each for each in self.main.findChildren(QtWidgets.QWidget) if each.metaObject().className() == "pqPropertiesPanel")

    def apply(self):
        self.click(self.until("button Apply", lambda: self.child(QtWidgets.QPushButton, "Accept")))
        self.wait(0.7)

    def question_mark(self):
        self.click(self.child(QtWidgets.QPushButton, "Help") or self.child(QtWidgets.QToolButton, "Help"))

    def labels(self):
        """What the panel shows of the proxy itself, without its display and view."""
        panel = self.child(QtWidgets.QWidget, "ProxyPanel", of=self.panel()) or self.panel()
        return [plain(each.text()) for each in panel.findChildren((QtWidgets.QLabel, QtWidgets.QCheckBox)) if each.isVisible() and each.text()]

    def property(self, name):
        """The widget of a property of the active proxy."""
        found = [each for each in self.panel().findChildren(QtWidgets.QWidget, name) if each.isVisible()]
        assert found, f"the panel does not show {name}"
        return found[0]

    def shows(self, name):
        return any(each.isVisible() for each in self.panel().findChildren(QtWidgets.QWidget, name))

    def choose(self, name, text):
        box = self.property(name).findChild(QtWidgets.QComboBox)
        assert box.findText(text) >= 0, f"{name} has no {text}: {[box.itemText(i) for i in range(box.count())]}"
        box.setCurrentIndex(box.findText(text))
        box.activated[int].emit(box.currentIndex())
        self.wait(0.2)

    def write(self, name, text):
        widget = self.property(name)
        field = widget.findChild(QtWidgets.QTextEdit) or widget.findChild(QtWidgets.QLineEdit) or widget
        field.setPlainText(text) if isinstance(field, QtWidgets.QTextEdit) else field.setText(text)
        self.wait(0.2)

    def row(self, view, number):
        """Clicks a row of a pipeline view, from 0 on."""
        height = 22 if view.fontMetrics().height() < 20 else view.fontMetrics().height() + 6
        QTest.mouseClick(view.viewport(), QtCore.Qt.LeftButton, pos=QtCore.QPoint(90, int((number + 0.5) * height)))
        self.wait(0.3)

    def in_dialogs(self, trigger, *answers):
        """Calls trigger, which opens dialogs one after the other, and each answer with its dialog. Whatever else opens is closed and a fault."""
        left, faults = list(answers), []
        looking, seen = [True], []

        def look():
            if looking:
                QtCore.QTimer.singleShot(400, look)  # an answer may open the next dialog, and return behind it
            dialog = self.app.activeModalWidget()
            try:
                if dialog is not None and dialog.isVisible() and dialog not in seen:
                    seen.append(dialog)
                    assert left, f"a dialog more: {dialog.windowTitle()}"
                    left.pop(0)(dialog)
            except BaseException as fault:  # else the dialog stays, and trigger does not return
                faults.append(fault)
                left.clear()
                dialog.reject()
        QtCore.QTimer.singleShot(400, look)
        trigger()
        self.until("dialog", lambda: not left)
        self.wait(0.6)
        looking.clear()
        if faults:
            raise faults[0]

    def name_file(self, file, kind=None):
        """The answer to a dialog of files."""
        def answer(dialog):
            if kind is not None:
                box = dialog.findChild(QtWidgets.QComboBox, "EntityType")
                kinds = [box.itemText(i) for i in range(box.count())]
                assert any(kind in each for each in kinds), f"no {kind} among {kinds}"
                box.setCurrentIndex(next(i for i, each in enumerate(kinds) if kind in each))
            dialog.findChild(QtWidgets.QLineEdit, "EntityName").setText(file)
            dialog.findChild(QtWidgets.QPushButton, "OK").click()
        return answer

    def ok(self, dialog):
        box = dialog.findChild(QtWidgets.QDialogButtonBox)
        button = box.button(QtWidgets.QDialogButtonBox.Ok) if box else None
        button = button or next(each for each in dialog.findChildren(QtWidgets.QPushButton) if plain(each.text()) == "OK")
        button.click()

    def view(self):
        return next(each for each in self.main.findChildren(QtWidgets.QWidget)
                    if each.metaObject().className() in ("pqQVTKWidget", "QVTKOpenGLNativeWidget", "QVTKOpenGLStereoWidget") and each.isVisible())

    def picture(self, file, widget=None):
        """What the screen shows of the window, or of one widget of it."""
        self.wait(0.5)
        widget = widget or self.main
        corner = widget.mapToGlobal(QtCore.QPoint(0, 0))
        shot = self.app.primaryScreen().grabWindow(0, corner.x(), corner.y(), widget.width(), widget.height())
        os.makedirs(os.path.dirname(file), exist_ok=True)
        assert shot.save(file), file
