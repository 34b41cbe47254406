# SPDX-License-Identifier: BSD-3-Clause
"""usage: run_readme.py README.md: its Python and its commands of the program knotwork do what they promise."""
import os
import re
import shlex
import subprocess
import sys

import knotwork_testing

with open(sys.argv[1], encoding="utf-8") as file:
    TEXT = file.read()
FOLDER = knotwork_testing.output("Readme/files")
os.makedirs(FOLDER, exist_ok=True)


def test_python():
    blocks = re.findall(r"^```python\n(.*?)^```", TEXT, re.M | re.S)
    assert blocks
    for block in blocks:
        files = re.findall(r'SetFileName\("([^"]+)"\)', block)
        done = subprocess.run([sys.executable, "-c", block], cwd=FOLDER, stderr=subprocess.PIPE, text=True)
        assert done.returncode == 0 and "ERR" not in done.stderr, done.stderr
        for name in files:
            assert os.path.getsize(os.path.join(FOLDER, name)) > 0, name


def test_commands():
    commands = re.findall(r"^    (knotwork .*)$", TEXT, re.M)
    assert commands
    for command in commands:
        words = shlex.split(command)
        done = subprocess.run([knotwork_testing.PROGRAM, *words[1:]], cwd=FOLDER, stderr=subprocess.PIPE, text=True)
        assert done.returncode == 0, (command, done.stderr)


knotwork_testing.main(globals())
