# SPDX-License-Identifier: BSD-3-Clause
"""clang-tidy with the checks of .clang-tidy over the sources that the last commit or the working tree changes.

usage: tidy.py CLANG_TIDY BUILD_FOLDER ROOT [--all]    (--all: every source that is built; exit status 77: there is nothing to look at)"""
import json
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

MOST_FILES = 60  # a source takes 5 to 10 s


def changed_files(root):
    """Changed by the last commit or since; none where the tree is no clone of two commits."""
    done = subprocess.run(["git", "-C", root, "diff", "--name-only", "--diff-filter=d", "HEAD~1"], capture_output=True, text=True, check=False)
    return [os.path.join(root, name) for name in done.stdout.split("\n") if name] if done.returncode == 0 else []


def commands(build, folder):
    """The commands of the build without precompiled headers, which are of another compiler, in a folder of their own; their sources."""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        found = json.load(file)
    for one in found:
        one["command"] = re.sub(r"-include \S*cmake_pch\.hxx", "", one["command"])
    with open(os.path.join(folder, "compile_commands.json"), "w", encoding="utf-8") as file:
        json.dump(found, file)
    return {os.path.realpath(one["file"]) for one in found}


def main():
    clang_tidy, build, root = (os.path.realpath(path) for path in sys.argv[1:4])
    with tempfile.TemporaryDirectory() as folder:
        built = commands(build, folder)
        own = {path for path in built if path.startswith(root + os.sep) and not path.startswith(build + os.sep)}
        wanted = sorted(own if sys.argv[4:] == ["--all"] else own.intersection(map(os.path.realpath, changed_files(root))))
        if not wanted:
            print("no source was changed")
            sys.exit(77)
        if len(wanted) > MOST_FILES and sys.argv[4:] != ["--all"]:
            print(f"{len(wanted)} sources were changed; the first {MOST_FILES} are looked at")
            wanted = wanted[:MOST_FILES]

        def look(path):
            return subprocess.run([clang_tidy, "--quiet", "-p", folder, path], capture_output=True, text=True, check=False)

        with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
            outcomes = list(pool.map(look, wanted))
    for done in outcomes:
        if done.returncode != 0:
            print(done.stdout)
    bad = sum(done.returncode != 0 for done in outcomes)
    print(f"{bad} of {len(wanted)} sources are not as .clang-tidy says")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
