# SPDX-License-Identifier: BSD-3-Clause
"""What the program says of itself, taken apart: man pages and completions are made of it."""
import functools
import re
import subprocess


class Help:
    """A `--help` text: sentence, usage, sections {title: [(term, meaning)]}, notes [paragraph]."""

    def __init__(self, text):
        lines = text.rstrip().split("\n")
        self.sentence = lines[0].strip()
        self.usage = next(line[len("Usage: "):].strip() for line in lines if line.startswith("Usage: "))
        self.sections, self.notes = {}, []
        entries = None
        for line in lines[1:]:
            title = re.fullmatch(r"([A-Z][\w ]*):", line)
            if title:
                entries = self.sections.setdefault(title[1], [])
            elif line.startswith("  ") and entries is not None:
                self._entry(entries, line)
            elif line and not line.startswith("Usage: "):
                entries = None
                self.notes.append(line.strip())

    @staticmethod
    def _entry(entries, line):
        if line.startswith(" " * 20):  # behind a long term
            term, meaning = entries[-1]
            entries[-1] = (term, (meaning + " " + line.strip()).strip())
        else:
            term, _, meaning = line.strip().partition("  ")
            if not meaning and line[29:30] == " ":  # one space between term and meaning
                term, meaning = line[2:30].strip(), line[30:].strip()
            entries.append((term.strip(), meaning.strip()))

    def options(self):
        """[(names, what follows, meaning)] of options and outputs, under whatever title."""
        found = []
        for entries in self.sections.values():
            for term, meaning in entries:
                names, _, rest = term.partition(" ")
                if names.startswith("-"):
                    found.append((names.split(","), rest, meaning))
        return found


@functools.lru_cache(maxsize=None)
def ask(program, *words):
    done = subprocess.run([program, *words, "--help"], stdout=subprocess.PIPE, text=True, check=True)
    return Help(done.stdout)


def jobs(program):
    """{name: sentence}"""
    return dict(ask(program).sections["Subcommands"])
