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
PAGE_FILES = os.path.join(os.path.dirname(os.path.abspath(sys.argv[1])), "Modules", "Python", "Testing")  # has page_files.py


def test_python():
    blocks = re.findall(r"^```python\n(.*?)^```", TEXT, re.M | re.S)
    assert blocks
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join([PAGE_FILES, os.environ.get("PYTHONPATH", "")]))
    subprocess.run([sys.executable, "-c", "import page_files; page_files.make_files()"], cwd=FOLDER, env=environment, check=True)
    for block in blocks:
        files = re.findall(r'(?:SetFileName|save)\("([^"]+)"\)', block)
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


def test_all_jobs_are_listed():
    done = subprocess.run([knotwork_testing.PROGRAM, "--help"], stdout=subprocess.PIPE, text=True)
    jobs = re.findall(r"^  (\w+) ", re.split(r"^subcommands:$", done.stdout, flags=re.M | re.I)[1], re.M)
    assert "fit" in jobs
    listed = re.search(r"one job a verb \(`([^`]+)`\)", TEXT).group(1).split()
    assert sorted(listed) == sorted(jobs), set(listed) ^ set(jobs)


def test_packages_that_examples_read_are_named():
    gallery = os.path.join(os.path.dirname(os.path.abspath(sys.argv[1])), "Examples", "Gallery")
    packages = set()
    for name in os.listdir(gallery):
        if name.endswith(".py"):
            with open(os.path.join(gallery, name), encoding="utf-8") as file:
                packages.update(re.findall(r"install the package ([\w-]+)", file.read()))
    assert packages
    for package in packages:
        assert f"`{package}`" in TEXT, package


knotwork_testing.main(globals())
