# SPDX-License-Identifier: BSD-3-Clause
"""usage: test_install_dependencies.py install-dependencies.sh FOLDER

The script with programs of our own in place of apt-get, dpkg-query, id and sudo: nothing is removed without leave.
"""
import os
import subprocess
import sys

SCRIPT, FOLDER = sys.argv[1:3]
PROGRAMS = {
    # every package but two is installed
    "dpkg-query": 'for p in "$@"; do case "$p" in -*|*Status*|python3-vtk9|xvfb) ;; *) echo "installed $p";; esac; done',
    "apt-get": 'echo "apt-get $*" >> "$LOG"; case " $* " in *" -s "*) cat "$PLAN"; exit "$PLAN_STATUS";; esac',
    "id": "echo 0",
    "sudo": 'exec "$@"',
}
HARMLESS = "Inst python3-vtk9 (9.1.0 Debian:12 [amd64])\nConf python3-vtk9 (9.1.0 Debian:12 [amd64])\n"
REMOVING = "Remv python3-paraview [5.11.0+dfsg-1+b1]\nRemv python3-mine [1]\n" + HARMLESS


def run(plan, plan_status=0, installed=False, **environment):
    """Exit status, text of both streams, calls of apt-get."""
    os.makedirs(FOLDER, exist_ok=True)
    for name, text in PROGRAMS.items():
        if installed and name == "dpkg-query":
            text = 'for p in "$@"; do echo "installed $p"; done'
        path = os.path.join(FOLDER, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\n" + text + "\n")
        os.chmod(path, 0o755)
    log, plan_file = os.path.join(FOLDER, "log"), os.path.join(FOLDER, "plan")
    open(log, "w").close()
    with open(plan_file, "w", encoding="utf-8") as file:
        file.write(plan)
    known = {key: value for key, value in os.environ.items() if not key.startswith("KNOTWORK_")}
    done = subprocess.run(
        ["bash", SCRIPT], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        env={**known, "PATH": FOLDER + ":" + os.environ["PATH"], "LOG": log, "PLAN": plan_file,
             "PLAN_STATUS": str(plan_status), **environment})
    with open(log, encoding="utf-8") as file:
        return done.returncode, done.stdout, file.read().splitlines()


def real(calls):
    """The calls that change the system."""
    return [call for call in calls if " install " in call and " -s " not in call]


def test_missing_packages_are_installed():
    status, _, calls = run(HARMLESS)
    assert status == 0 and len(real(calls)) == 1, calls
    assert real(calls)[0].endswith("python3-vtk9 xvfb"), calls
    assert " --no-remove " in real(calls)[0], calls  # should the plan have changed since


def test_removals_stop_it():
    status, text, calls = run(REMOVING)
    assert status == 1 and not real(calls), calls
    assert "would remove: python3-paraview python3-mine\n" in text and "KNOTWORK_ALLOW_REMOVALS=1" in text, text


def test_removals_are_made_with_leave():
    status, text, calls = run(REMOVING, KNOTWORK_ALLOW_REMOVALS="1")
    assert status == 0 and len(real(calls)) == 1 and "--no-remove" not in real(calls)[0], calls
    assert "Removing: python3-paraview python3-mine\n" in text, text


def test_what_cannot_be_installed_is_said():
    status, text, calls = run("", plan_status=100)
    assert status == 1 and not real(calls) and "cannot install: python3-vtk9 xvfb" in text, (text, calls)


def test_nothing_is_done_when_nothing_is_missing_or_allowed():
    assert run(REMOVING, installed=True) == (0, "", [])
    assert run(REMOVING, KNOTWORK_NO_INSTALL="1") == (0, "", [])


TESTS = [item for name, item in list(globals().items()) if name.startswith("test_")]
for test in TESTS:
    test()
print(len(TESTS), "passed")
