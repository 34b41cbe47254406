# SPDX-License-Identifier: BSD-3-Clause
"""What the program says of itself: every example in --help runs as it stands, and wrong words are named before missing ones, with the
name that is nearest."""
import re
import shutil
import tempfile

import knotwork_testing
from job_inputs import make_files
from refusals import good, path

# names in the examples, and the files they stand for
FILES = {"plate.vtu": "square.vtu", "west.vtu": "square.vtu", "east.vtu": "east.vtu", "terrain.vtu": "height.vtu",
         "new.vtu": "height.vtu", "old.vtu": "height.vtu", "scan.xyz": "cloud.xyz", "shell.off": "mesh.off",
         "template.vtp": "template.vtp", "target.vtp": "target.vtp", "boundary.json": "boundary.json"}


def jobs():
    """Names of all jobs, from --help."""
    text = knotwork_testing.run_program("--help").stdout
    return re.findall(r"^  ([a-z]+) ", text[text.index("Subcommands:"):], re.MULTILINE)


def wrong(*arguments):
    """The one line of a wrong usage."""
    done = knotwork_testing.run_program(*arguments)
    assert done.returncode == 2 and done.stdout == "", (arguments, done)
    lines = done.stderr.splitlines()
    assert len(lines) == 1 and lines[0].startswith("knotwork"), (arguments, lines)
    return lines[0]


def test_every_example_runs():
    make_files()
    names = jobs()
    assert len(names) >= 20, names
    for name in names:
        example = re.findall(r"^Example: knotwork (.*)$", knotwork_testing.run_program(name, "--help").stdout, re.MULTILINE)
        assert len(example) == 1 and example[0].split()[0] == name, (name, example)
        with tempfile.TemporaryDirectory(dir=path("")) as folder:
            for own, made in FILES.items():
                shutil.copy(path(made), folder + "/" + own)
            done = knotwork_testing.run_program(*example[0].split(), "--quiet", folder=folder)
        assert done.returncode == 0 and done.stderr == "", (example, done)


def test_unknown_words_are_named_first():
    for arguments, word, nearest in (
            (["fti", "x.xyz"], "fti", "'fit'"), (["tesselate", "x.vtu"], "tesselate", "'tessellate'"),
            (["fit", "--tolerence", 1], "--tolerence", "'--tolerance'"), (["fit", "--tolernace=1"], "--tolernace", "'--tolerance'"),
            (["refine", "a.vtu", "--number-of-refinement", 2], "--number-of-refinement", "'--number-of-refinements'"),
            (["map", "a", "b", "--ouput", "c.vtu"], "--ouput", "'--output'"), (["source", "--shpae", "cube"], "--shpae", "'--shape'")):
        line = wrong(*arguments)
        assert f"'{word}'" in line and "did you mean " + nearest + "?" in line and "required" not in line, line
    for arguments, word in ((["--bogus"], "--bogus"), (["fit", "--bogus"], "--bogus"), (["quux"], "quux")):
        line = wrong(*arguments)
        assert f"'{word}'" in line and "did you mean" not in line, line
    assert "'c' is one word too many" in wrong("refine", "a.vtu", "c", "--output", "b.vtu")
    assert "a job is required" in wrong()
    assert "--output is required" in wrong("refine", "a.vtu")


def test_ranges_are_short():
    for arguments, text in ((["--tolerance", -1], "at least 0"), (["--tolerance", 1e300], "at least 0"), (["--degree", 77], "1 to 9"),
                            (["--degree", "many"], "1 to 9")):
        line = wrong("fit", "a.xyz", "--output", "b.vtu", *arguments)
        assert line.endswith(": " + text + "; 'knotwork fit --help' lists its options") and len(line) < 200, line


def test_old_spelling_and_short_output():
    grid, fine = path("one.vtu"), path("two.vtu")
    good("source", "-o", grid)
    for words in (["--max-level", 3], ["--max-level=3"], ["--maximum-level", 3]):
        done = knotwork_testing.run_program("refine", grid, "-o", fine, *words)
        assert done.returncode == 0, (words, done)
        warning = "'--max-level' is an old spelling of '--maximum-level'\n"
        assert done.stderr == (warning if "max-" in words[0] else ""), (words, done.stderr)
    done = knotwork_testing.run_program("refine", grid, "-o", fine, "--max-level", 3, "--quiet")
    assert done.returncode == 0 and done.stderr == "", done
    assert "'--max-lvl'" in wrong("refine", grid, "-o", fine, "--max-lvl", 3)


knotwork_testing.main(globals())
