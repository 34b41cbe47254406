#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the libraries that every program, library and plugin of build trees links with the table of licences in README.md.

usage: check_libraries.py README TREE... [--permissive]

A row of the table: library | names of its files | licence | who links it | whether a permissive build does. Who links it are modules (their
libraries, also those of the plugin) and programs; Python modules, which link what the linker finds on its way to the libraries of their modules,
may link what has a row. Refused are: a library without a row, or linked by what the row does not
name; with --permissive a library that such a build does not link; else a row that nothing links. Lists of all binaries go to the output."""
import argparse
import fnmatch
import os
import re
import subprocess
import sys

# of the system: under the GPL with the exception of the run-time library, or the LGPL; VTK's own are VTK
SYSTEM = ("libc.so*", "libm.so*", "libstdc++.so*", "libgcc_s.so*", "ld-linux*", "libpthread.so*", "libdl.so*", "librt.so*")
OWN = ("libvtkKnotwork*", "Knotwork.so")
PYTHON = "a Python module"
LEFT_OUT = ("Testing", "CMakeFiles", "Temporary", "_deps")  # folders of what no user gets


def rows_of(readme):
    """Library, patterns of files, who links it (None: everything), permissive."""
    with open(readme, encoding="utf-8") as file:
        text = file.read()
    found = re.search(r"<!-- libraries -->\n(.*?)<!-- end -->", text, re.S)
    if not found:
        sys.exit(f"{readme}: there is no table between '<!-- libraries -->' and '<!-- end -->'")
    rows = []
    for line in found[1].splitlines()[2:]:
        library, files, _, users, permissive = (cell.strip() for cell in line.strip("|").split("|"))
        names = None if users == "everything" else set(re.findall(r"[\w-]+", users))
        rows.append((library, re.findall(r"`([^`]+)`", files), names, permissive == "yes"))
    return rows


def binaries(tree):
    """Programs, libraries and plugins that users get."""
    for folder, folders, files in os.walk(tree):
        folders[:] = sorted(name for name in folders if name not in LEFT_OUT)
        for name in sorted(files):
            path = os.path.join(folder, name)
            is_program = re.fullmatch(r"knotwork(-[\w-]+)?(\.so)?", name) and os.access(path, os.X_OK)
            is_library = fnmatch.fnmatch(name, "*Knotwork*.so*")
            if (is_program or is_library) and not os.path.islink(path):
                with open(path, "rb") as file:
                    if file.read(4) == b"\x7fELF":
                        yield path


def linked(path):
    said = subprocess.run(["readelf", "-d", "-W", path], capture_output=True, text=True, check=True).stdout
    return re.findall(r"\(NEEDED\).*\[(.*)\]", said)


def user_of(path):
    """The module or program of a binary."""
    name = os.path.basename(path)
    if name.startswith("vtkKnotwork"):
        return PYTHON
    found = re.match(r"libvtkKnotwork(\w+)\.", name)
    return found[1] if found else "plugin" if name.startswith("Knotwork.") else name.removesuffix(".so")


def matches(name, patterns):
    return any(fnmatch.fnmatch(name, pattern) for pattern in patterns)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("readme")
    parser.add_argument("trees", nargs="+")
    parser.add_argument("--permissive", action="store_true")
    arguments = parser.parse_args()
    rows = rows_of(arguments.readme)
    faults, used, count = [], {}, 0
    for tree in arguments.trees:
        for path in binaries(tree):
            count += 1
            user = user_of(path)
            libraries = [name for name in linked(path) if not matches(name, SYSTEM + OWN)]
            print(os.path.relpath(path, tree) + ":", *libraries)
            for name in libraries:
                row = next((each for each in rows if matches(name, each[1])), None)
                if row is None:
                    faults.append(f"{path} links {name}, which has no row")
                    continue
                if user == PYTHON:
                    user_is_named = True
                else:
                    used.setdefault(row[0], set()).add(user)
                    user_is_named = row[2] is None or user in row[2]
                if not user_is_named:
                    faults.append(f"{path} links {name}; the row of {row[0]} does not name {user}")
                if arguments.permissive and not row[3]:
                    faults.append(f"{path} links {name}, which a permissive build must not")
    if count == 0:
        faults.append(f"there are no programs and libraries in {', '.join(arguments.trees)}")
    if not arguments.permissive:
        built = set().union(*used.values())  # the plugin need not be
        faults += [f"nothing links {row[0]}, but the table says so" for row in rows if row[0] not in used and (row[2] != {"plugin"} or "plugin" in built)]
    for library, users in sorted(used.items()):
        print(f"{library}: linked by {', '.join(sorted(users))}")
    sys.exit("\n".join(faults) if faults else 0)


if __name__ == "__main__":
    main()
