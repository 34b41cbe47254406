# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's own window on a virtual screen: ten tasks of users, driven by its menus, buttons and dialogs, whose views are compared with
pictures; menus, toolbar, panels and help show what they should. tasks_in_window.py says what is done."""
import os
import re
import shutil
import subprocess
import tempfile

import knotwork_testing

HERE = os.path.dirname(os.path.abspath(__file__))


def run():
    """What the window prints, and the folder of its pictures."""
    for program in ("paraview", "Xvfb"):
        if not shutil.which(program):
            knotwork_testing.skip(f"there is no {program}")
    try:
        import PyQt5.QtTest  # noqa: F401
    except ImportError:
        knotwork_testing.skip("there is no python3-pyqt5, which drives the window")
    folder = os.path.dirname(knotwork_testing.output("window/files"))
    plugin = os.path.dirname(os.environ["KNOTWORK_PLUGIN"])
    with tempfile.TemporaryDirectory() as home:
        done = subprocess.run(
            ["paraview", "--dr", "--plugin-search-paths", plugin, "--plugins", "Knotwork", "--script", os.path.join(HERE, "tasks_in_window.py")],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=900,
            env={**os.environ, "HOME": home, "XDG_RUNTIME_DIR": home, "KNOTWORK_WINDOW": folder, "KNOTWORK_WINDOW_SCRIPTS": HERE})
    print(done.stdout)
    return done


DONE = run()
TASKS = re.findall(r"^done (\w+)$", DONE.stdout, re.M)


def test_everything_was_done():
    assert DONE.returncode == 0 and len(TASKS) == 14, (DONE.returncode, TASKS)


def test_no_errors():
    assert "ERR|" not in DONE.stdout and "Traceback" not in DONE.stdout


def test_pictures():
    compared = 0
    for task in TASKS:
        if os.path.exists(knotwork_testing.output(f"window/Window_{task}.png")):
            shutil.copy(knotwork_testing.output(f"window/Window_{task}.png"), knotwork_testing.output(f"Window_{task}.png"))
            knotwork_testing.compare_image(f"Window_{task}")
            compared += 1
    assert compared == 10, compared


knotwork_testing.main(globals())
