# SPDX-License-Identifier: BSD-3-Clause
"""Tables of pages that scripts write."""
import pathlib


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
