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
    """First and last cells of the rows of a table whose last column has this title, and the line below that tells about it; else None."""
    begin, end = (f"<!-- {name}: {word} -->\n" for word in ("begin", "end"))
    lines = pathlib.Path(page).read_text(encoding="utf-8").split(begin)[1].split(end)[0].rstrip("\n").split("\n")
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
    return ([(row[0], row[-1]) for row in rows[2:]], lines[-1]) if rows and rows[0][-1] == title else None


def write_column(page, name, title, cells, note):
    """Puts a last column into a table of a page, or replaces it, and a line that tells about it below.

    cells: first and last cell of rows in the order of the table, of which it may have some only."""
    begin, end = (f"<!-- {name}: {word} -->\n" for word in ("begin", "end"))
    old = read_column(page, name, title)
    lines = pathlib.Path(page).read_text(encoding="utf-8").split(begin)[1].split(end)[0].rstrip("\n").split("\n")
    lines = lines[:-2] if old else lines
    rows = [line for line in lines if line.startswith("|")]
    rest = [line for line in lines if not line.startswith("|")]
    if old:
        rows = [row[:row.rstrip("|").rindex("|") + 1] for row in rows]
    left = iter(cells)
    last = [next(cell for first, cell in left if first == row.strip("|").split("|")[0].strip()) for row in rows[2:]]
    rows = [f"{row} {cell} |" for row, cell in zip(rows, [title, "---", *last])]
    write_table(page, name, "\n".join([*rows, *rest, "", note]))
