# SPDX-License-Identifier: BSD-3-Clause
"""Tables of pages that scripts write."""
import pathlib

PORTABLE_COLUMN = "portable / native"  # which portable.py writes and table.py keeps


def write_table(page, name, text):
    """Puts text between the comment lines `NAME: begin` and `NAME: end` of a page."""
    page = pathlib.Path(page)
    begin, end = (f"<!-- {name}: {word} -->\n" for word in ("begin", "end"))
    before, rest = page.read_text(encoding="utf-8").split(begin)
    page.write_text(before + begin + text.rstrip("\n") + "\n" + end + rest.split(end)[1], encoding="utf-8")


def table_text(head, rows):
    """Rows of texts below a head, as pages have them."""
    lines = ["| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in [head, *rows]]
    return "\n".join([lines[0], "|" + " --- |" * len(head), *lines[1:]]) + "\n"


def read_column(page, name, title):
    """The cells below the title of a table's last column, and the last line that tells about it; None without."""
    begin, end = (f"<!-- {name}: {word} -->\n" for word in ("begin", "end"))
    lines = pathlib.Path(page).read_text(encoding="utf-8").split(begin)[1].split(end)[0].rstrip("\n").split("\n")
    cells = [[cell.strip() for cell in line.strip("|").split("|")][-1] for line in lines if line.startswith("|")]
    return (cells[2:], lines[-1]) if cells[0] == title else None


def write_column(page, name, title, cells, note):
    """Puts a last column into a table of a page, or replaces it, and a line that tells about it below."""
    begin, end = (f"<!-- {name}: {word} -->\n" for word in ("begin", "end"))
    old = read_column(page, name, title)
    lines = pathlib.Path(page).read_text(encoding="utf-8").split(begin)[1].split(end)[0].rstrip("\n").split("\n")
    lines = lines[:-2] if old else lines
    rows = [line for line in lines if line.startswith("|")]
    rest = [line for line in lines if not line.startswith("|")]
    if len(rows) != len(cells) + 2:
        raise ValueError(f"{name}: {len(rows) - 2} rows, {len(cells)} cells")
    if old:
        rows = [row[:row.rstrip("|").rindex("|") + 1] for row in rows]
    rows = [f"{row} {cell} |" for row, cell in zip(rows, [title, "---", *cells])]
    write_table(page, name, "\n".join([*rows, *rest, "", note]))
