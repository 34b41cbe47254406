# SPDX-License-Identifier: BSD-3-Clause
"""Sphinx's settings for the site that build_site.py makes; it says in the environment which version and where Doxygen's XML is."""
import os
import re

project = "Knotwork"
author = "the Knotwork authors"
copyright = "the Knotwork authors, BSD-3-Clause"
version = release = os.environ["KNOTWORK_VERSION"]

extensions = ["myst_parser", "sphinx.ext.autodoc", "breathe"]
root_doc = "index"
myst_heading_anchors = 4
myst_enable_extensions = ["html_image"]
highlight_language = "none"
suppress_warnings = ["myst.header"]  # pages of modules begin sections under tables at any level

breathe_projects = {"knotwork": os.environ["KNOTWORK_DOXYGEN_XML"]}
breathe_default_project = "knotwork"
breathe_show_include = False
autodoc_member_order = "alphabetical"

html_theme = "furo"
html_title = f"Knotwork {version}"
html_copy_source = False
html_show_sphinx = False
html_static_path = ["style.css"]
html_css_files = ["style.css"]


def format_docstring(app, what, name, thing, options, lines):
    """The package's docstrings are plain text: a line "name = default: sentence" is a parameter, any other line stands as it is."""
    made, listed = [], False
    for line in map(str.strip, lines):
        found = re.match(r"(\w+)( = (?:'[^']*'|[^:'])+)?: (.*)", line)
        text = re.sub(r"([\\*`|_])", r"\\\1", found[3] if found else line)
        if found:
            made += ([] if listed else [""]) + [f"* **{found[1]}**" + (f" = ``{found[2][3:]}``" if found[2] else "") + ": " + text]
        elif listed and text and not re.match("Returns?|Raises", text):
            made.append("  " + text)
        else:
            made += ["", text] if listed else [text]
        listed = bool(found) or (listed and made[-1].startswith("  "))
    lines[:] = made + [""]


def setup(app):
    app.connect("autodoc-process-docstring", format_docstring)
