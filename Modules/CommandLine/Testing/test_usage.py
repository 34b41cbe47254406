# SPDX-License-Identifier: BSD-3-Clause
"""What the program says of itself: every example in --help runs as it stands, and wrong words are named before missing ones, with the
name that is nearest."""
import os
import re
import shutil
import subprocess
import tempfile
from xml.etree import ElementTree

import knotwork_testing
from job_inputs import make_files
from refusals import good, path

MODULES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
# names in the examples, and the files they stand for
FILES = {"plate.vtu": "square.vtu", "part.step": "square.step", "west.vtu": "square.vtu", "east.vtu": "east.vtu", "terrain.vtu": "height.vtu",
         "new.vtu": "height.vtu", "old.vtu": "height.vtu", "scan.xyz": "cloud.xyz", "samples.csv": "samples.csv", "shell.off": "mesh.off", "part.off": "quads.off", "section.vtu": "quads.vtu", "scan.off": "quads.off", "cow.off": "quads.off",
         "template.vtp": "template.vtp", "target.vtp": "target.vtp", "boundary.json": "boundary.json", "problem.json": "problem.json",
         "solid.step": "solid.step", "solid.vtu": "cube.vtu", "mesh.vtu": "cube.vtu"}


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


def test_help_is_a_word_too():
    run = knotwork_testing.run_program
    assert run("help").stdout == run("--help").stdout and "knotwork help JOB" in run("help").stdout
    for name in ("fit", "contour"):
        done = run("help", name)
        assert done.returncode == 0 and done.stdout == run(name, "--help").stdout and f"Usage: knotwork {name}" in done.stdout
    assert "'fit'" in wrong("help", "fti")


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


def listed(text, sentence):
    """Endings behind a sentence of --help."""
    lines = re.findall("^" + sentence + ": ((?:.+\n)+?)(?=\n|Files)", text, re.MULTILINE)
    assert len(lines) == 1, text
    return set(lines[0].split())


def test_formats_of_help_pages_and_paraview_are_one_list():
    text = knotwork_testing.run_program("--help").stdout
    read, written = listed(text, "Files that are read"), listed(text, "Files that are written")
    assert {".vtu", ".json", ".off"} <= read and {".vtu", ".vti"} <= written and ".off" not in written, (read, written)
    with open(os.path.join(MODULES, "CommandLine", "README.md"), encoding="utf-8") as stream:
        page = stream.read()
    rows = page[page.index("| data | endings |"):].split("\n\n")[0]
    assert set(re.findall(r"\.[a-z][a-z0-9]+", rows)) == written, rows
    dialogs = ElementTree.parse(os.path.join(MODULES, "SplineIO", "ParaView", "SplineIO.xml"))
    for kind, known, own in (("ReaderFactory", read, {".vtu", ".vtp", ".vtpc", ".pvtu", ".pvtp", ".vti", ".vtk", ".obj", ".stl"}),
                             ("WriterFactory", written, {".vtu", ".vtp", ".vtpc", ".pvtu", ".pvtp", ".vti", ".csv", ".obj", ".stl", ".ply"})):
        offered = ["." + ending for one in dialogs.iter(kind) for ending in one.get("extensions").split()]
        assert set(offered) | own == known, (kind, set(offered) ^ known)  # the others are ParaView's own


def test_options_are_no_values_of_others():
    for arguments, option, following in ((["info", "a.vtu", "--report", "--quiet"], "--report", "--quiet"), (["convert", "a.vtu", "-o", "--force"], "-o", "--force"),
                                         (["tessellate", "a.vtu", "--chordal-tolerance", "--output=b.vtp"], "--chordal-tolerance", "--output=b.vtp"),
                                         (["cadmodify", "a.step", "--heal", "--output", "b.step"], "--heal", "--output")):
        line = wrong(*arguments)
        assert f"'{option}' needs a value" in line and f"'{following}'" in line, line
    assert not os.path.exists("--quiet")
    done = knotwork_testing.run_program("source", "--output", path("c.vtu"), "--report=--quiet", "--quiet")
    assert done.returncode == 0 and os.path.exists("--quiet"), done
    os.remove("--quiet")


def test_unknown_endings_list_the_known_ones():
    text = knotwork_testing.run_program("--help").stdout
    read = listed(text, "Files that are read")
    for ending, nearest in ((".vtuu", "'.vtu'"), (".setp", "'.step'"), (".jsn", "'.json'"), (".docx", "")):
        file = path("misspelled" + ending)
        good("source", "--output", path("sheet.vtu"))
        shutil.copy(path("sheet.vtu"), file)
        done = knotwork_testing.run_program("info", file)
        assert done.returncode == 1 and read <= set(done.stderr.split()), done
        assert ("did you mean " + nearest if nearest else "formats") in done.stderr and (nearest != "") == ("did you" in done.stderr), done
        done = knotwork_testing.run_program("source", "--output", file)
        assert done.returncode == 1 and "change the ending" in done.stderr, done
    done = knotwork_testing.run_program("source", "--output", path("a.stpe"))
    assert "did you mean '.st" in done.stderr, done


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


def test_options_stand_under_titles():
    text = knotwork_testing.run_program("fit", "--help").stdout
    titles = re.findall(r"^([A-Z][\w ]*):$", text, re.MULTILINE)
    assert {"Outputs", "General", "Tolerance", "Refinement", "Outliers"} <= set(titles) and len(titles) == len(set(titles)), titles
    assert max(part.count("\n  --") for part in re.split(r"^[A-Z][\w ]*:$", text, flags=re.MULTILINE)) <= 12, text
    general = re.search(r"^General:\n((?:  .*\n)+)", text, re.MULTILINE)[1]
    assert all(each in general for each in ("--help", "--force", "--threads", "--quiet")), general


def test_start_loads_neither_CAD_nor_rendering():
    """They would be most of the time that the program needs to begin."""
    said = subprocess.run(["ldd", knotwork_testing.PROGRAM], stdout=subprocess.PIPE, text=True, check=True).stdout
    names = [line.split()[0] for line in said.splitlines()]
    assert any(name.startswith("libvtkKnotworkSplineIO") for name in names), names
    heavy = [name for name in names if re.match(r"libTK|libvtkRendering|libX11|libE?GL|libfreeimage|libfontconfig|libpython|libgdal|libproj", name)]
    assert not heavy, heavy


def test_CAD_is_found_from_everywhere():
    """A program found on PATH does not know its own folder by its first word."""
    before = os.environ["PATH"]
    with tempfile.TemporaryDirectory(dir=path("")) as folder:
        os.environ["PATH"] = knotwork_testing.BIN_DIR + os.pathsep + before
        try:
            done = subprocess.run(["knotwork", "source", "--output", "square.step", "--quiet"], cwd=folder, stderr=subprocess.PIPE, text=True)
        finally:
            os.environ["PATH"] = before
        assert done.returncode == 0 and os.path.getsize(folder + "/square.step") > 0, done
        done = subprocess.run([knotwork_testing.PROGRAM, "source", "--output", "none.step"], cwd=folder, stderr=subprocess.PIPE, text=True,
                              env={**os.environ, "KNOTWORK_WORKERS": folder})
        assert done.returncode == 1 and "knotwork-opencascade.so" in done.stderr and "KNOTWORK_WORKERS" in done.stderr, done
        assert not os.path.exists(folder + "/none.step")


knotwork_testing.main(globals())
