#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the modules and the edges between them as KnotworkModules.cmake states them: Modules/modules.svg.

usage: draw_modules.py ROOT [--check]    (--check: exit status 1 when the drawn picture is not that of the list)
A module stands above all it uses, as high as it can; an edge that follows from others is left out."""
import os
import re
import sys

WIDTH, HEIGHT, ACROSS, GAP, UP = 190, 46, 220, 40, 96
PROGRAMS = ("CommandLine", "Python", "ParaViewPlugin")


def edges_of(root):
    """Modules, each with those whose kernels or filters it uses."""
    with open(os.path.join(root, "CMake", "KnotworkModules.cmake")) as stream:
        stated = re.findall(r"^knotwork_module\((\w+)([^)]*)\)", stream.read(), re.M)
    return {module: set(uses.split()) - {"KERNELS", "FILTERS"} for module, uses in stated}


def reach(uses, module):
    found = set()
    for name in uses[module]:
        found |= {name} | reach(uses, name)
    return found


def reduced(uses):
    return {module: {name for name in names if not any(name in reach(uses, other) for other in names - {name})}
            for module, names in uses.items()}


def rows_of(uses):
    """Modules by how many arrows lead down to them at the most: what no module uses is in the first row."""
    def depth(module):
        return 1 + max((depth(user) for user, names in uses.items() if module in names), default=-1)
    rows = {}
    for module in sorted(uses):
        rows.setdefault(depth(module), []).append(module)
    return rows


def draw(uses):
    rows = {level + 1: row for level, row in rows_of(uses).items()}
    rows[0] = list(PROGRAMS)
    level_of = {name: level for level, row in rows.items() for name in row}
    tops = set(uses) - {name for names in uses.values() for name in names}
    ways = []  # of an arrow: its ends, and a place in every row that it crosses
    for module, name in [(p, t) for p in PROGRAMS for t in sorted(tops)] + [(m, n) for m in sorted(uses) for n in sorted(uses[m])]:
        between = [(module, name, level) for level in range(level_of[module] + 1, level_of[name])]
        for place in between:
            rows[place[2]].append(place)
        ways.append([module] + between + [name])
    above = {}
    for way in ways:
        for upper, lower in zip(way, way[1:]):
            above.setdefault(lower, []).append(upper)
    x = {}
    for level in sorted(rows):  # a row in the order of the means of what points to it
        if level > 1:
            rows[level].sort(key=lambda item: sum(x[user] for user in above[item]) / len(above[item]))
        widths = [ACROSS if item in level_of else GAP for item in rows[level]]
        for i, item in enumerate(rows[level]):
            x[item] = sum(widths[:i]) + widths[i] / 2 - sum(widths) / 2
    left = min(x.values()) - ACROSS / 2
    lines = ['<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" font-family="sans-serif" font-size="14">' % (
        max(x.values()) + ACROSS / 2 - left, len(rows) * UP),
        '<defs><marker id="tip" markerWidth="9" markerHeight="9" refX="8" refY="4" orient="auto">'
        '<path d="M0,0 L9,4 L0,8 z" fill="#557"/></marker></defs>', '<rect width="100%" height="100%" fill="white"/>']
    for way in ways:
        y = 20 + level_of[way[0]] * UP + HEIGHT
        points = ["%g,%g" % (x[way[0]] - left, y)]
        for item in way[1:-1]:
            points += ["%g,%g" % (x[item] - left, 20 + item[2] * UP), "%g,%g" % (x[item] - left, 20 + item[2] * UP + HEIGHT)]
        points.append("%g,%g" % (x[way[-1]] - left, 20 + level_of[way[-1]] * UP))
        lines.append('<polyline points="%s" fill="none" stroke="#557" marker-end="url(#tip)"/>' % " ".join(points))
    for name, level in level_of.items():
        fill = "#f4e3c1" if name in PROGRAMS else "#d6e6f5"
        u, v = x[name] - left, 20 + level * UP
        lines.append('<rect x="%g" y="%g" width="%d" height="%d" rx="6" fill="%s" stroke="#335"/>' % (u - WIDTH / 2, v, WIDTH, HEIGHT, fill))
        lines.append('<text x="%g" y="%g" text-anchor="middle">%s</text>' % (u, v + HEIGHT / 2 + 5, name))
    return "\n".join(lines) + "\n</svg>\n"


def main(root, check):
    file = os.path.join(root, "Modules", "modules.svg")
    text = draw(reduced(edges_of(root)))
    if not check:
        with open(file, "w") as stream:
            stream.write(text)
        return 0
    with open(file) as stream:
        same = stream.read() == text
    print("the picture of the modules is %s" % ("that of the list" if same else "old: run CMake/draw_modules.py ."))
    return 0 if same else 1


sys.exit(main(sys.argv[1], "--check" in sys.argv[2:]))
