#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the modules and the edges between them as the build files state them: Modules/modules.svg.

usage: draw_modules.py ROOT [--check]    (--check: exit status 1 when the drawn picture is not that of the build files)
A module stands above all it uses; an edge that follows from others is left out."""
import os
import re
import sys

WIDTH, HEIGHT, ACROSS, UP = 190, 46, 230, 96
PROGRAMS = ("CommandLine", "Python", "ParaViewPlugin")


def words_after(text, keyword):
    """The names after a keyword of a build file, up to the next keyword."""
    found = re.search(r"\b%s((?:\s+Knotwork::\w+|\s+VTK::\w+|\s+[A-Z][A-Za-z]*[a-z][A-Za-z]*)+)" % keyword, text)
    return [] if not found else found.group(1).split()


def edges_of(root):
    """Modules, each with those whose kernels or filters it uses. SplineGrid holds the filters of SplineCore."""
    uses = {}
    for module in sorted(os.listdir(os.path.join(root, "Modules"))):
        names = set()
        for file, keywords in (("Kernel/CMakeLists.txt", ("DEPENDS",)), ("vtk.module", ("DEPENDS", "PRIVATE_DEPENDS"))):
            path = os.path.join(root, "Modules", module, file)
            if os.path.exists(path):
                with open(path) as stream:
                    text = stream.read()
                for keyword in keywords:
                    names |= {name.replace("Knotwork::", "") for name in words_after(text, keyword) if "VTK::" not in name}
                uses[module] = names
    uses["SplineGrid"] = uses.get("SplineGrid", set()) | {"SplineCore"}
    return {module: {name for name in names if name in uses and name != module} for module, names in uses.items()}


def reach(uses, module):
    found = set()
    for name in uses[module]:
        found |= {name} | reach(uses, name)
    return found


def reduced(uses):
    return {module: {name for name in names if not any(name in reach(uses, other) for other in names - {name})}
            for module, names in uses.items()}


def rank(uses, module):
    return 1 + max((rank(uses, name) for name in uses[module]), default=-1)


def draw(uses):
    rows = {}
    for module in sorted(uses):
        rows.setdefault(rank(uses, module), []).append(module)
    top = max(rows) + 1
    rows[top] = list(PROGRAMS)
    across = max(len(row) for row in rows.values())
    shift = [0 if len(rows[level]) > 1 else (-1) ** level * ACROSS * 0.6 for level in range(top + 1)]  # edges pass beside boxes
    place = {name: (20 + (across - len(row)) * ACROSS / 2 + i * ACROSS + shift[level], 20 + (top - level) * UP)
             for level, row in rows.items() for i, name in enumerate(row)}
    lines = ['<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" font-family="sans-serif" font-size="14">' % (
        across * ACROSS + 10, (top + 1) * UP),
        '<defs><marker id="tip" markerWidth="9" markerHeight="9" refX="8" refY="4" orient="auto">'
        '<path d="M0,0 L9,4 L0,8 z" fill="#557"/></marker></defs>', '<rect width="100%" height="100%" fill="white"/>']
    tops = set(uses) - {name for names in uses.values() for name in names}
    arrows = [(module, name) for module in sorted(uses) for name in sorted(uses[module])]
    arrows += [(program, name) for program in PROGRAMS for name in sorted(tops)]
    for module, name in arrows:
        (x, y), (u, v) = place[module], place[name]
        lines.append('<line x1="%g" y1="%g" x2="%g" y2="%g" stroke="#557" marker-end="url(#tip)"/>' % (
            x + WIDTH / 2, y + HEIGHT, u + WIDTH / 2, v))
    for name, (x, y) in place.items():
        fill = "#f4e3c1" if name in PROGRAMS else "#d6e6f5"
        lines.append('<rect x="%g" y="%g" width="%d" height="%d" rx="6" fill="%s" stroke="#335"/>' % (x, y, WIDTH, HEIGHT, fill))
        lines.append('<text x="%g" y="%g" text-anchor="middle">%s</text>' % (x + WIDTH / 2, y + HEIGHT / 2 + 5, name))
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
    print("the picture of the modules is %s" % ("that of the build files" if same else "old: run CMake/draw_modules.py ."))
    return 0 if same else 1


sys.exit(main(sys.argv[1], "--check" in sys.argv[2:]))
