#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""usage: man_pages.py PROGRAM VERSION FOLDER

Writes FOLDER/knotwork.1 and a knotwork-JOB.1 for every job of the program, from what --help says."""
import os
import re
import sys

import job_help


def troff(text):
    """Lines may break behind the commas and bars of long lists."""
    escaped = re.sub(r"([,|])(?=\S)", r"\1\\:", text.replace("\\", "\\e").replace("-", "\\-"))
    return re.sub(r"^([.'])", r"\\&\1", escaped, flags=re.M)


def terms(entries):
    for term, meaning in entries:
        yield ".TP\n.B " + troff(term) + "\n" + (troff(meaning) or "\\&")


def page(name, version, found, see):
    lines = [f'.TH {name.upper()} 1 "" "Knotwork {version}" "User Commands"', ".SH NAME", f"{troff(name)} \\- {troff(found.sentence)}",
             ".SH SYNOPSIS", ".B " + troff(found.usage)]
    for title, entries in found.sections.items():
        lines += [".SH " + title.upper(), *terms(entries)]
    for note in found.notes:
        title, _, words = note.partition(": ")
        if title in ("Example", "Exit status"):
            lines += [".SH " + title.upper(), *([".nf"] if title == "Example" else []), troff(words),
                      *([".fi"] if title == "Example" else [])]
        else:
            lines += [".PP", troff(note)]
    lines += [".SH SEE ALSO", ",\n".join(f".BR {troff(each)} (1)" if each.startswith("knotwork") else troff(each) for each in see)]
    return "\n".join(lines) + "\n"


def main(program, version, folder):
    os.makedirs(folder, exist_ok=True)
    names = job_help.jobs(program)
    pages = {"knotwork": page("knotwork", version, job_help.ask(program), [f"knotwork-{each}" for each in sorted(names)])}
    for name in names:
        pages[f"knotwork-{name}"] = page(f"knotwork-{name}", version, job_help.ask(program, name), ["knotwork"])
    for name, text in pages.items():
        with open(os.path.join(folder, name + ".1"), "w", encoding="utf-8") as stream:
            stream.write(text)


if __name__ == "__main__":
    main(*sys.argv[1:])
