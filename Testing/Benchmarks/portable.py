#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares a build for every processor with one for this processor, and writes the last column of a table of speeds.

usage: Testing/Benchmarks/portable.py [--dry] [--rounds N] MODULE [PORTABLE_TREE [NATIVE_TREE]]     (default build/release, build/benchmark)

Runs the benchmarks of one thread that Testing/Benchmarks/MODULE.json names (see table.py) in both trees in turns, five
times (--rounds), and takes the fastest of each: time of the portable build over that of the native one, below 1 where the
portable one is faster. Benchmarks below a twentieth of a second, and those that are more than a tenth apart, are run four
times as often. Of a row it is the first time; "times" lists counters that are times, too. Where a benchmark counts
`evaluations`, which rounding may change, times are those of an evaluation. --dry prints and leaves the page.
"""
import argparse
import json
import os
import pathlib
import re
import sys

import page_tables
import table

SHORT = 0.05  # seconds
DOUBTFUL = 0.1  # away from 1


def timed(row, spec):
    """The benchmark of a row, and the counter that is its time, if any."""
    if "columns" not in spec:
        return row[2], None
    for cell in row:
        if not cell.startswith("@"):
            continue
        name, unit, *other = cell[1:].split()
        if not other and (unit in table.SCALE or unit == "1/s" or unit in spec.get("times", [])):
            return name, unit if unit in spec.get("times", []) else None
    return None, None


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--dry", action="store_true")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("module")
    parser.add_argument("trees", nargs="*", type=pathlib.Path)
    given = parser.parse_args()
    module = given.module
    trees = given.trees + [root / "build/release", root / "build/benchmark"][len(given.trees):]
    spec = json.loads((root / f"Testing/Benchmarks/{module}.json").read_text())
    if "needs" in spec and spec["needs"] not in os.environ:
        sys.exit(f"set {spec['needs']}: not all rows can be measured without it")
    rows = [timed(row, spec) for row in spec["rows"]]
    load = os.getloadavg()[0]
    best = [{}, {}]

    def measure(names):
        pattern = "|".join(sorted({re.sub(r"([.+*?()])", r"\\\1", name) for name in names}))
        for tree, fastest in zip(trees, best):
            found = table.measure(tree / "bin" / spec["program"], f"^({pattern})(/(min_time|iterations|repeats).*)?$", spec.get("statistic", "min"))
            for row in rows:
                name, counter = row
                if name not in names or (name, "failed") in found:
                    continue
                seconds = found[name, counter] if counter else found[name]
                seconds /= found.get((name, "evaluations"), 1.0)
                fastest[row] = min(fastest.get(row, seconds), seconds)

    for _ in range(given.rounds):
        measure({name for name, _ in rows if name})
    again = {row[0] for row, seconds in best[1].items() if seconds < SHORT or abs(best[0][row] / seconds - 1.0) > DOUBTFUL}
    for _ in range(4 * given.rounds if again else 0):
        measure(again)
    cells = [f"{best[0][row] / best[1][row]:.2f}" if row in best[1] else "" for row in rows]
    note = (f"Last column: time of one thread in a build for every processor over that of `-march=native`, {table.processor()}, load "
            f"{load:.1f}, by `Testing/Benchmarks/portable.py {module}`.")
    for row, cell in zip(spec["rows"], cells):
        print(cell, row[0])
    if not given.dry:
        page_tables.write_column(root / spec["page"], f"benchmarks {module}", page_tables.PORTABLE_COLUMN,
                                 [(row[0], cell) for row, cell in zip(spec["rows"], cells)], note)


if __name__ == "__main__":
    main()
