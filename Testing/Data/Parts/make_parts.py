# SPDX-License-Identifier: BSD-3-Clause
"""Writes the parts of this folder. Needs Debian's python3-gmsh, for OpenCASCADE.

usage: make_parts.py FOLDER
"""
import os
import sys

import gmsh


def piston(occ):
    """Crown, skirt and pin bore: a cup, 60 high, 80 wide, with a wall of 6 and a bottom of 14, bored along x."""
    radius, inner, height, crown = 40, 34, 60, 14
    cup = occ.cut([(3, occ.addCylinder(0, 0, 0, 0, 0, height, radius))], [(3, occ.addCylinder(0, 0, -1, 0, 0, height - crown + 1, inner))])[0]
    occ.cut(cup, [(3, occ.addCylinder(-radius - 5, 0, 22, 2 * radius + 10, 0, 0, 9))])


def main():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    for name, make in (("piston.step", piston),):
        make(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        gmsh.write(os.path.join(sys.argv[1], name))
        gmsh.clear()


if __name__ == "__main__":
    main()
