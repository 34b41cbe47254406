# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the program that must fail well: exit status 1, one line, no output files, existing ones untouched."""
import os
import re
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import knotwork_testing

KEPT = "kept as it is"


def path(name):
    """In a folder of the test's own: several may run at once."""
    return knotwork_testing.output(os.path.join("cli_bad", os.path.splitext(os.path.basename(sys.argv[0]))[0], name))


def write_text(name, text):
    with open(path(name), "w") as stream:
        stream.write(text)
    return path(name)


def write_bytes(name, content):
    with open(path(name), "wb") as stream:
        stream.write(content)
    return path(name)


def good(*arguments):
    """Runs a job that must succeed."""
    done = knotwork_testing.run_program(*arguments)
    assert done.returncode == 0, (arguments, done.stderr)


def outcome(arguments, before=False):
    """Exit status and stderr of a job. It runs in a folder of its own, so outputs are named without one. A failure has said so in
    one line and left no file, and those that were there before as they were."""
    outputs = [name for name in map(str, arguments) if re.fullmatch(r"[a-z]\w*\.\w+", name)]
    with tempfile.TemporaryDirectory(dir=os.path.dirname(path("runs"))) as folder:
        files = [os.path.join(folder, name) for name in outputs] if before else []
        for file in files:
            with open(file, "w") as stream:
                stream.write(KEPT)
        done = knotwork_testing.run_program(*arguments, folder=folder)
        assert done.returncode in (0, 1, 3, 4, 5), (arguments, done.returncode, done.stderr)
        if done.returncode == 1:
            assert len(done.stderr.splitlines()) == 1, (arguments, done.stderr)
            assert sorted(os.listdir(folder)) == sorted(map(os.path.basename, files)), (arguments, os.listdir(folder))
            for file in files:
                with open(file) as stream:
                    assert stream.read() == KEPT, (arguments, file)
        else:
            assert not [name for name in os.listdir(folder) if name.startswith(".")], (arguments, os.listdir(folder))
        return done.returncode, done.stderr


def refuse(arguments, *words, before=False):
    """The job fails as it should, with the words in its line."""
    status, text = outcome(arguments, before)
    assert status == 1, (arguments, status, text)
    for word in words:
        assert word in text, (arguments, word, text)


def refuse_all(cases):
    """Pairs of arguments and words, side by side; every other one with outputs that are there before."""
    together((lambda arguments=arguments, words=words, before=i % 2 == 1: refuse(arguments, *words, before=before))
             for i, (arguments, words) in enumerate(cases))


def together(calls):
    """Runs all, as many at once as there are cores; every one that failed is told."""
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        futures = [pool.submit(call) for call in calls]
    failures = [str(future.exception()) for future in futures if future.exception()]
    assert not failures, f"{len(failures)} of {len(futures)}:\n" + "\n".join(failures)
