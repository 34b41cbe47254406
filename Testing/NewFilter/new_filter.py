# SPDX-License-Identifier: BSD-3-Clause
"""A filter and its job are added to a copy of the tree: their files, and the edits of other files, which are counted. What is generated
(PrintSelf, options, ParaView's proxy, what Python checks, the tables of the pages) knows their properties, and the compiler takes all of it.

usage: new_filter.py COMPILER INCLUDE_FOLDER...    (folders as the program's sources see them, one argument of all, separated by ;)"""
import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
MOST_EDITS = {"filter": 4, "job": 1}

# file: (text, the text that takes its place)
EDITS = {
    "filter": {
        "Modules/SplineGrid/CMakeLists.txt": ("    vtkSplineRefine\n", "    vtkSplineRefine\n    vtkSplineShift\n"),
        "Modules/SplineGrid/ParaView/SplineGrid.xml": (
            '    <SourceProxy name="SplineExtract"', '''    <SourceProxy name="SplineShift" class="vtkSplineShift" label="Spline Shift">
      <Documentation short_help="Spline grids elsewhere">Shifts the points of spline grids.</Documentation>
      <Input name="Input">The spline grid.</Input>
      <Properties/>
    </SourceProxy>

    <SourceProxy name="SplineExtract"'''),
        "README.md": ("| | `vtkGismoXMLReader`", "| | `vtkSplineShift` | shifts splines | spline grid -> spline grid | exact | - |\n| | `vtkGismoXMLReader`"),
        "Modules/SplineGrid/README.md": ("## vtkSplineWarp", "## vtkSplineShift\n\n<!-- properties of vtkSplineShift -->\n<!-- end -->\n\n## vtkSplineWarp"),
    },
    "job": {"Modules/CommandLine/CMakeLists.txt": ("  Session.cxx\n", "  Session.cxx\n  ShiftJob.cxx\n")},
}


def copy_tree(folder):
    """What generators read, and the command line's sources."""
    for where, folders, names in os.walk(os.path.join(ROOT, "Modules")):
        folders[:] = [name for name in folders if name not in ("Kernel", "Testing")]
        made = os.path.join(folder, os.path.relpath(where, ROOT))
        os.makedirs(made, exist_ok=True)
        for name in names:
            shutil.copy(os.path.join(where, name), made)
    shutil.copy(os.path.join(ROOT, "README.md"), folder)


def edit(path, old, new):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    assert text.count(old) == 1, f"{path}: {old!r} is there {text.count(old)} times"
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace(old, new))


def generate(*arguments):
    done = subprocess.run([sys.executable, os.path.join(ROOT, "CMake", "properties.py"), *arguments], capture_output=True, text=True,
                          check=False)
    return done.returncode, done.stderr


def check_generated(folder):
    """Makes what the build makes; returns the sources to compile."""
    grid = os.path.join(folder, "Modules", "SplineGrid")
    headers = [os.path.join(grid, name) for name in sorted(os.listdir(grid)) if name.startswith("vtk") and name.endswith(".h")]
    made = os.path.join(folder, "made")
    os.mkdir(made)
    place = {name: os.path.join(made, name) for name in ("PrintSelf.cxx", "FilterProperties", "SplineGrid.xml", "properties.py")}
    source = os.path.join(grid, "ParaView", "SplineGrid.xml")
    for arguments in (("print-self", place["PrintSelf.cxx"]), ("options", place["FilterProperties"]),
                      ("proxies", place["SplineGrid.xml"], source), ("python", place["properties.py"])):
        status, message = generate(*arguments, *headers)
        assert status == 0, message
    proxy = ElementTree.parse(place["SplineGrid.xml"]).getroot().find(".//SourceProxy[@name='SplineShift']")
    assert [each.get("name") for each in proxy if each.tag.endswith("VectorProperty")] == ["Way", "Distance", "Threads"]
    assert [each.get("text") for each in proxy.iter("Entry")] == ["Along X", "Along Z"]
    with open(place["properties.py"], encoding="utf-8") as file:
        table = {}
        exec(file.read(), table)
    assert table["PROPERTIES"]["vtkSplineShift"]["Distance"][:4] == ("double", 1, 0, 1000)
    with open(os.path.join(folder, "Modules", "CommandLine", "README.md"), encoding="utf-8") as file:
        assert "| `shift` | shift a spline | `knotwork shift plate.vtu --way along-x --output shifted.vtu` |" in file.read()
    return [place["PrintSelf.cxx"], place["FilterProperties"] + ".cxx", os.path.join(grid, "vtkSplineShift.cxx"),
            os.path.join(folder, "Modules", "CommandLine", "ShiftJob.cxx")]


def main():
    compiler, folders = sys.argv[1], sys.argv[2].split(";")
    with tempfile.TemporaryDirectory() as folder:
        copy_tree(folder)
        for name in ("vtkSplineShift.h", "vtkSplineShift.cxx"):
            shutil.copy(os.path.join(HERE, name), os.path.join(folder, "Modules", "SplineGrid"))
        # each edit of a page is asked for
        for file, missing in (("README.md", "has no vtkSplineShift"), ("Modules/SplineGrid/README.md", "no page has")):
            status, message = generate("pages", "--check", folder)
            assert status != 0 and missing in message, message
            edit(os.path.join(folder, file), *EDITS["filter"][file])
        shutil.copy(os.path.join(HERE, "ShiftJob.cxx"), os.path.join(folder, "Modules", "CommandLine"))
        for edits in EDITS.values():
            for file, texts in edits.items():
                if not file.endswith(".md"):
                    edit(os.path.join(folder, file), *texts)
        assert generate("pages", folder) == (0, "") and generate("pages", "--check", folder) == (0, "")
        public = os.path.join(folder, "include", "knotwork", "SplineGrid")
        os.makedirs(public)
        shutil.copy(os.path.join(HERE, "vtkSplineShift.h"), public)
        sources = check_generated(folder)
        commands = os.path.join(folder, "Modules", "CommandLine")
        before = [os.path.join(folder, "include"), os.path.join(folder, "made"), os.path.join(folder, "Modules", "SplineGrid"), commands]
        flags = ["-std=c++17", "-fsyntax-only", "-Wall", "-Werror"] + ["-I" + where for where in before]
        # the folders of the program itself come after those of the copy
        flags += [word for where in folders if where != "/usr/include" and "CommandLine" not in where
                  for word in ("-isystem", where)]
        for path in sources:
            done = subprocess.run([compiler, *flags, path], capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stderr
    for kind, edits in EDITS.items():
        print(f"a {kind} edits {len(edits)} files: " + ", ".join(sorted(edits)))
        assert len(edits) <= MOST_EDITS[kind]


if __name__ == "__main__":
    main()
