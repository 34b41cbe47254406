# SPDX-License-Identifier: BSD-3-Clause
"""The module's page is complete: every property of every class with its default, every error code, every picture."""
import glob
import os
import re

import knotwork
import knotwork_testing

MODULE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
KERNEL = os.path.join(MODULE, "..", "SplineCore", "Kernel")
CLASSES = ["vtkSplineSource", "vtkSplineRefine", "vtkSplineExtract", "vtkSplineTessellate", "vtkSplineEvaluate",
           "vtkSplineWarp", "vtkSplineControlNet", "vtkSplineParametricMesh", "vtkUnstructuredSpline",
           "vtkMeshPatches"]


def read(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


PAGE = read(MODULE, "README.md")


def section(title):
    """Text from the heading that begins with the title to the next heading."""
    found = re.search(r"^## " + re.escape(title) + r"\b.*?(?=^## |\Z)", PAGE, re.M | re.S)
    assert found, f"the page has no section {title}"
    return found.group(0)


def properties(name):
    """What the class and its base for filters add to VTK's algorithms: names with Set and Get."""
    algorithm = next(c for c in getattr(knotwork, name).__mro__ if c.__name__ == "vtkDataObjectAlgorithm")
    names = set(dir(getattr(knotwork, name))) - set(dir(algorithm))
    return sorted(n[3:] for n in names if n.startswith("Set") and "Get" + n[3:] in names)


def is_default(made, value, cell):
    """Whether a cell of the table says the value, of an enumeration by its name."""
    cell = cell.replace("`", "").strip()
    if isinstance(getattr(made, cell, None), int):
        return getattr(made, cell) == value
    if value is None or value == "":
        return cell in ("none", "empty")
    if isinstance(value, bool):
        return cell == ("on" if value else "off")
    if isinstance(value, str):
        return value in cell
    values = list(value) if isinstance(value, tuple) else [value]
    numbers = [float(n) for n in re.findall(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?", cell)]
    return numbers[:len(values)] == [float(v) for v in values]


def test_every_property_is_in_a_table():
    for name in CLASSES:
        table = re.search(r"^\| property \| default \| range \| meaning \|\n((?:\|.*\n)+)", section(name), re.M).group(1)
        rows = {}
        for row in re.findall(r"^\| (`.*) \|$", table, re.M):
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", row)]
            rows[cells[0].strip("`")] = cells
        made = getattr(knotwork, name)()
        assert "Threads" in properties(name)
        for option in properties(name):
            if option not in rows:
                assert f"`Set{option}`" in section(name), f"{name}: no row for {option}"
                continue
            assert is_default(made, getattr(made, "Get" + option)(), rows[option][1]), (name, option, rows[option])
            assert len(rows[option]) == 4 and rows[option][3], (name, option)


def test_every_error_code_is_in_the_table():
    enumeration = re.search(r"enum class ErrorCode\s*\{(.*?)\};", read(KERNEL, "Base", "Status.h"), re.S).group(1)
    codes = re.findall(r"^\s*(\w+)", enumeration, re.M)
    used = set()
    sources = glob.glob(os.path.join(MODULE, "*.cxx")) + glob.glob(os.path.join(KERNEL, "**", "*.cxx"), recursive=True)
    assert any(os.path.dirname(file) != MODULE for file in sources), "no source of the kernel"
    for file in sources:
        if os.path.basename(file) != "Status.cxx":
            used |= set(re.findall(r"ErrorCode::(\w+)", read(file)))
    used -= {"Ok", "UserError", "NoError"}
    assert len(used) > 10
    sentences = dict(re.findall(r"case ErrorCode::(\w+):\s*return \"(.*?)\"", read(KERNEL, "Base", "Status.cxx")))
    rows = dict(re.findall(r"^\| (\d+) \|(.*?)\|", section("Errors and their meaning"), re.M))
    for code in used:
        number = str(codes.index(code))
        assert number in rows, f"no row for {code} ({number})"
        assert rows[number].strip() in ("", sentences[code]), (code, rows[number])


def test_pictures_and_anchors_exist():
    pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", PAGE) + re.findall(r'<img src="([^"]+)"', PAGE)
    assert len(pictures) >= 10
    for picture in pictures:
        path = os.path.join(MODULE, picture)
        assert os.path.exists(path), picture
        assert os.path.getsize(path) < 200 * 1024, picture
    anchors = set()
    for heading in re.findall(r"^#+ (.*)$", PAGE, re.M):
        anchors.add(re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-"))
    for link in re.findall(r"\]\(#([^)]+)\)", PAGE):
        assert link in anchors, link


def test_examples_of_the_page_compile():
    examples = re.findall(r"```python\n(.*?)```", PAGE, re.S)
    assert len(examples) >= 5
    for example in examples:
        compile(example, "README.md", "exec")
        for name, method in re.findall(r"^(\w+)\.((?:Set|Get)\w+)", example, re.M):
            made = re.search(rf"^{name} = knotwork\.(\w+)\(\)", example, re.M)
            if made:
                assert hasattr(getattr(knotwork, made.group(1)), method), (made.group(1), method)


knotwork_testing.main(globals())
