# SPDX-License-Identifier: BSD-3-Clause
"""usage: run_readme.py README.md FILES VERSION: its snippets run on copies of what the folder FILES holds, it names all jobs and packages, and the
newest of the changes are those of the version."""
import os
import re
import subprocess
import sys

import knotwork_testing
import page_snippets

README, FILES, VERSION = sys.argv[1:4]
with open(README, encoding="utf-8") as file:
    TEXT = file.read()


def test_snippets():
    assert page_snippets.main(README, os.path.dirname(knotwork_testing.output("Readme/files")), FILES) == 0


def test_version():
    with open(os.path.join(os.path.dirname(os.path.abspath(README)), "CHANGELOG.md"), encoding="utf-8") as stream:
        assert re.search(r"^## (\S+)$", stream.read(), re.M)[1] == VERSION


def test_all_jobs_are_listed():
    done = subprocess.run([knotwork_testing.PROGRAM, "--help"], stdout=subprocess.PIPE, text=True)
    jobs = re.findall(r"^  (\w+) ", re.split(r"^subcommands:$", done.stdout, flags=re.M | re.I)[1], re.M)
    assert "fit" in jobs
    listed = re.search(r"one job a verb \(`([^`]+)`\)", TEXT).group(1).split()
    assert sorted(listed) == sorted(jobs), set(listed) ^ set(jobs)


def test_packages_that_examples_read_are_named():
    gallery = os.path.join(os.path.dirname(os.path.abspath(README)), "Examples", "Gallery")
    packages = set()
    for name in os.listdir(gallery):
        if name.endswith(".py"):
            with open(os.path.join(gallery, name), encoding="utf-8") as file:
                packages.update(re.findall(r"install the package ([\w-]+)", file.read()))
    assert packages
    for package in packages:
        assert f"`{package}`" in TEXT, package


knotwork_testing.main(globals())
