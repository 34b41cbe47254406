# SPDX-License-Identifier: BSD-3-Clause
"""Man pages and completions that are made of --help: a page a job with every option, shells that complete jobs, options and choices."""
import os
import shutil
import subprocess
import sys
import tempfile

import knotwork_testing

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "CMake", "Packages"))
import completions  # noqa: E402
import job_help  # noqa: E402
import man_pages  # noqa: E402

PROGRAM = knotwork_testing.PROGRAM


def plain(text):
    """What troff shows of a page's source."""
    return text.replace("\\:", "").replace("\\-", "-").replace("\\&", "").replace("\\e", "\\")


def test_every_job_has_a_page_with_every_option():
    with tempfile.TemporaryDirectory() as folder:
        man_pages.main(PROGRAM, "1.2.3", folder)
        names = job_help.jobs(PROGRAM)
        assert len(names) > 30 and all(sentence for sentence in names.values())
        assert sorted(os.listdir(folder)) == sorted(["knotwork.1"] + [f"knotwork-{name}.1" for name in names])
        for name in names:
            with open(os.path.join(folder, f"knotwork-{name}.1"), encoding="utf-8") as stream:
                text = plain(stream.read())
            said = subprocess.run([PROGRAM, name, "--help"], stdout=subprocess.PIPE, text=True, check=True).stdout
            # the words of the help, whatever its columns
            options = [word for word in said.split("\n") if word.startswith("  -")]
            assert len(options) >= 5
            for line in options:
                spelling = line.split()[0]
                assert f".B {spelling}" in text, (name, spelling)
            for title in (".SH NAME", ".SH SYNOPSIS", ".SH EXAMPLE", ".SH EXIT STATUS"):
                assert title in text, (name, title)
            shown = set(text.split())
            lost = [word for word in said.split() if word not in shown and not word.endswith(":")]
            assert len(lost) <= 0.02 * len(said.split()), (name, lost)
        if shutil.which("groff"):
            for file in os.listdir(folder):
                done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", os.path.join(folder, file)], stdout=subprocess.PIPE,
                                      stderr=subprocess.PIPE, check=True)
                assert b"error" not in done.stderr, done.stderr


def complete(file, *words):
    script = (f"source {file}; compopt() {{ :; }}; COMP_WORDS=({' '.join(repr(word) for word in words)}); "
              f"COMP_CWORD={len(words) - 1}; _knotwork; echo \"${{COMPREPLY[@]}}\"")
    return subprocess.run(["bash", "-c", script], stdout=subprocess.PIPE, text=True, check=True).stdout.split()


def test_shells_complete():
    with tempfile.TemporaryDirectory() as folder:
        bash, zsh = os.path.join(folder, "bash"), os.path.join(folder, "zsh")
        completions.main(PROGRAM, bash, zsh)
        assert complete(bash, "knotwork", "cont") == ["contour"]
        assert set(complete(bash, "knotwork", "")) == set(job_help.jobs(PROGRAM)) | {"--help", "--version"}
        assert complete(bash, "knotwork", "fit", "--method", "") == ["least-squares", "mba", "combined"]
        assert complete(bash, "knotwork", "fit", "--method", "m") == ["mba"]
        assert complete(bash, "knotwork", "contour", "--lev") == ["--levels"]
        assert "--output" in complete(bash, "knotwork", "contour", "--")
        if shutil.which("zsh"):
            subprocess.run(["zsh", "-n", zsh], check=True)


knotwork_testing.main(globals())
