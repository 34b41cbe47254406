#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures and writes the table of speeds on a module's page.

usage: Testing/Benchmarks/table.py MODULE [BUILD_TREE]     (default build/benchmark)

Testing/Benchmarks/MODULE.json names the page, the program, of which only the benchmarks that "filter" names are run, and the
rows. Without "columns" a row is: what is done, the unit, the benchmark of one thread, that of all threads, and for each peer
a published number or the name of a benchmark of ours that does the same by plain loops. With "columns" a row is a list of
cells: a text; or what was measured, `@BENCHMARK UNIT` where the unit is one of time, `1/s`, or a counter of the benchmark; or
a ratio, `@BENCHMARK COUNTER BENCHMARK`; `no result` where the benchmark says that it failed. The table goes between two comment lines `benchmarks MODULE: begin` and `... end` on
the page; the rows listed under "readme" go to the README alike. "needs" names an environment variable without which not all
rows can be measured; "repetitions" is their number where it is not 20; "statistic" is "median" where it is not "min".
"""
import json
import os
import pathlib
import platform
import subprocess
import sys

import page_tables

SCALE = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}


def measure(program, only, statistic):
    """Seconds (a point or cell where the benchmark counts such) by benchmark, and its counters by (benchmark, counter);
    of the fastest or the median repetition."""
    done = subprocess.run([program, "--benchmark_format=json", f"--benchmark_filter={only}"], check=True,
                          capture_output=True, text=True)
    found = {}
    for run in json.loads(done.stdout)["benchmarks"]:
        name = run["run_name"].replace("/real_time", "")
        name = "/".join(part for part in name.split("/") if not part.startswith(("iterations", "min_time", "repeats", "process_time")))
        if run.get("error_occurred"):
            found[name, "failed"] = run["error_message"]
        if run.get("aggregate_name") != statistic:
            continue
        time = run["real_time" if "real_time" in run["run_name"] else "cpu_time"] * SCALE[run["time_unit"]]
        found[name] = run.get("point", run.get("cell", time))
        found.update(((name, key), value) for key, value in run.items() if isinstance(value, (int, float)))
    return found


def show(seconds, unit):
    value = seconds / SCALE[unit.split("/")[0]]
    return f"{value:.3g}" if value < 100 else f"{value:,.0f}"


def cell(text, found):
    """A cell of a table with columns."""
    if not text.startswith("@"):
        return text
    name, unit, *other = text[1:].split()
    if (name, "failed") in found:
        return "no result"
    if other:
        return f"{found[name, unit] / found[other[0], unit]:.2f}"
    if unit == "1/s":
        return f"{1 / found[name]:.1e}".replace("e+0", "e")
    if unit in SCALE:
        return show(found[name], unit)
    value = found[name, unit]
    if abs(value) >= 1e6:
        return f"{value:.0e}"
    return f"{value:.0f}" if value == round(value) else f"{value:.3g}" if value < 0.01 else f"{value:.4f}"


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return platform.machine()


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    module = sys.argv[1]
    tree = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else root / "build/benchmark"
    spec = json.loads((root / f"Testing/Benchmarks/{module}.json").read_text())
    if "needs" in spec and spec["needs"] not in os.environ:
        sys.exit(f"set {spec['needs']}: not all rows can be measured without it")
    load = os.getloadavg()[0]
    found = measure(tree / "bin" / spec["program"], spec.get("filter", "."), spec.get("statistic", "min"))
    rows = []
    if "columns" in spec:
        columns = spec["columns"]
        rows = ["| " + " | ".join(cell(text, found) for text in row) + " |" for row in spec["rows"]]
    else:
        columns = ["what", "unit", "one thread", "all threads", *spec["peers"]]
        for what, unit, one, every, *peers in spec["rows"]:
            cells = [what, unit, show(found[one], unit), show(found[every], unit) if every else ""]
            cells += [show(found[peer], unit) if peer in found else peer for peer in peers]
            rows.append("| " + " | ".join(cells) + " |")
    lines = ["| " + " | ".join(columns) + " |", "|" + " --- |" * len(columns)]
    other, options = ("", "") if tree.name == "benchmark" else (f" build/{tree.name}", " -DKNOTWORK_BENCHMARKS=ON")
    closing = ["", f"{processor()}, {os.cpu_count()} threads, load {load:.1f} at the start, "
               f"{'median' if spec.get('statistic') == 'median' else 'fastest'} of "
               f"{spec.get('repetitions', 20)} repetitions; "
               "one thread: processor time. The command:", "",
               f"    cmake --preset {tree.name}{options} && cmake --build --preset {tree.name}",
               f"    {spec['needs'] + '=<folder> ' if 'needs' in spec else ''}Testing/Benchmarks/table.py {module}{other}"]
    page, name = root / spec["page"], f"benchmarks {module}"
    last = page_tables.read_column(page, name, page_tables.PORTABLE_COLUMN)
    page_tables.write_table(page, name, "\n".join(lines + rows + closing))
    if last and len(last[0]) == len(rows):
        page_tables.write_column(page, name, page_tables.PORTABLE_COLUMN, *last)
    if "readme" in spec:
        page_tables.write_table(root / "README.md", f"benchmarks {module}", "\n".join(lines + [rows[i] for i in spec["readme"]]))


if __name__ == "__main__":
    main()
