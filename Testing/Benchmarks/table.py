#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures and writes the table of speeds on a module's page.

usage: Testing/Benchmarks/table.py MODULE [BUILD_TREE]     (default build/benchmark)

Testing/Benchmarks/MODULE.json names the page, the program and the rows: what is done, the unit, the benchmark of one
thread, that of all threads, and for each peer a published number or the name of a benchmark of ours that does the same
by plain loops. The table goes between two comment lines `benchmarks MODULE: begin` and `... end` on the page; the rows
listed under "readme" go to the README alike.
"""
import json
import os
import pathlib
import platform
import subprocess
import sys

SCALE = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}


def measure(program):
    """Seconds (a point where the benchmark counts points) and cells a second by benchmark; the fastest repetition."""
    done = subprocess.run([program, "--benchmark_format=json"], check=True, capture_output=True, text=True)
    found = {}
    for run in json.loads(done.stdout)["benchmarks"]:
        if run.get("aggregate_name") != "min":
            continue
        name = run["run_name"].replace("/real_time", "")
        name = "/".join(part for part in name.split("/") if not part.startswith(("min_time", "repeats")))
        time = run["real_time" if "real_time" in run["run_name"] else "cpu_time"] * SCALE[run["time_unit"]]
        found[name] = run.get("point", time)
    return found


def show(seconds, unit):
    value = seconds / SCALE[unit.split("/")[0]]
    return f"{value:.3g}" if value < 100 else f"{value:,.0f}"


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return platform.machine()


def insert(page, module, lines):
    begin, end = f"<!-- benchmarks {module}: begin -->", f"<!-- benchmarks {module}: end -->"
    before, rest = page.read_text().split(begin)
    page.write_text(before + begin + "\n" + "\n".join(lines) + "\n" + end + rest.split(end)[1])


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    module = sys.argv[1]
    tree = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else root / "build/benchmark"
    spec = json.loads((root / f"Testing/Benchmarks/{module}.json").read_text())
    load = os.getloadavg()[0]
    found = measure(tree / "bin" / spec["program"])
    lines = ["| what | unit | one thread | all threads | " + " | ".join(spec["peers"]) + " |",
             "| --- | --- | --- | --- |" + " --- |" * len(spec["peers"])]
    rows = []
    for what, unit, one, every, *peers in spec["rows"]:
        cells = [what, unit, show(found[one], unit), show(found[every], unit) if every else ""]
        cells += [show(found[peer], unit) if peer in found else peer for peer in peers]
        rows.append("| " + " | ".join(cells) + " |")
    closing = ["", f"{processor()}, {os.cpu_count()} threads, load {load:.1f} at the start, fastest of 20 repetitions; "
               "one thread: processor time. The command:", "",
               "    cmake --preset benchmark && cmake --build --preset benchmark",
               f"    Testing/Benchmarks/table.py {module}"]
    insert(root / spec["page"], module, lines + rows + closing)
    insert(root / "README.md", module, lines + [rows[i] for i in spec["readme"]])


if __name__ == "__main__":
    main()
