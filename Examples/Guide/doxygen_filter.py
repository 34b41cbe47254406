# SPDX-License-Identifier: BSD-3-Clause
"""usage: doxygen_filter.py HEADER

A header as Doxygen is to read it: without the marks that hold a setter and its getter together and without forward declarations, and what a kernel's
header declares as a group of the header's name, which Breathe can show."""
import os
import re
import sys

file = sys.argv[1]
with open(file, encoding="utf-8") as stream:
    text = re.sub(r"^ *///@[{}]$", "", stream.read(), flags=re.M)
text = re.sub(r"^(template <[^>\n]*>\n)?(struct|class|enum class) \w+;$", lambda found: "\n" if found[1] else "", text, flags=re.M)
begin, end = text.rfind("namespace knotwork\n{\n"), text.rfind("\n}")
if os.sep + "Kernel" + os.sep in file and 0 <= begin < end:
    begin += len("namespace knotwork\n{")
    outside = re.search(r"^template <[^\n]*>\n[\w:<>& ]+ \w+::\w+\(", text[begin:end], re.M)  # a member's definition, which was declared before
    end = begin + outside.start() if outside else end
    name = re.sub(r"\W", "_", os.path.basename(file))
    opened = f"\n/** @addtogroup {name} {os.path.basename(file)}\n * @{{\n */"
    text = text[:begin] + opened + text[begin:end] + "\n/** @} */\n" + text[end:]
sys.stdout.write(text)
