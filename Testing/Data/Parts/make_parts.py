# SPDX-License-Identifier: BSD-3-Clause
"""Writes the parts of this folder. Needs Debian's python3-gmsh, for OpenCASCADE.

usage: make_parts.py FOLDER
"""
import math
import os
import sys

import gmsh


def piston(occ):
    """Crown, skirt and pin bore: a cup, 60 high, 80 wide, with a wall of 6 and a bottom of 14, bored along x."""
    radius, inner, height, crown = 40, 34, 60, 14
    cup = occ.cut([(3, occ.addCylinder(0, 0, 0, 0, 0, height, radius))], [(3, occ.addCylinder(0, 0, -1, 0, 0, height - crown + 1, inner))])[0]
    occ.cut(cup, [(3, occ.addCylinder(-radius - 5, 0, 22, 2 * radius + 10, 0, 0, 9))])


def bracket(occ):
    """Sheet 2 thick: a base of 60 x 40 with two holes of 8 and a corner cut off, a flange of 30 bent up at x = 60 and a
    lug of 16 x 15 bent up at y = 40, inner radii of 3, a slot in the flange."""
    thick, inner, width, base, flange = 2, 3, 40, 60, 30
    outer = inner + thick

    def bend(x, y, axis, begin, length):
        """Quarter of a tube about a line above the base along an axis; the hollow side looks up and back."""
        place = (x, begin, thick + inner) if axis == 1 else (begin, y, thick + inner)
        way = (0, length, 0) if axis == 1 else (length, 0, 0)
        ring = occ.cut([(3, occ.addCylinder(*place, *way, outer))], [(3, occ.addCylinder(*place, *way, inner))])[0]
        corner = (x, begin, 0) if axis == 1 else (begin, y, 0)
        size = (outer, length, outer) if axis == 1 else (length, outer, outer)
        return occ.intersect(ring, [(3, occ.addBox(*corner, *size))])[0]

    sheet = [(3, occ.addBox(0, 0, 0, base, width, thick))]
    pieces = bend(base, 0, 1, 0, width) + [(3, occ.addBox(base + inner, 0, outer, thick, width, flange))]
    pieces += bend(0, width, 0, 15, 16) + [(3, occ.addBox(15, width + inner, outer, 16, thick, 15))]
    part = occ.fuse(sheet, pieces)[0]
    holes = [(3, occ.addCylinder(x, 20, -1, 0, 0, thick + 2, 4)) for x in (15, 42)]
    slot = [(3, occ.addBox(base, 14, outer + 10, outer + 1, 12, 8))]
    holes += occ.fuse(slot, [(3, occ.addCylinder(base, y, outer + 14, outer + 1, 0, 0, 4)) for y in (14, 26)])[0]
    wedge = [(3, occ.addBox(-20, -20, -1, 20, 40, thick + 2))]
    occ.rotate(wedge, 0, 0, 0, 0, 0, 1, math.pi / 4)
    occ.translate(wedge, 5, 5, 0)
    occ.cut(part, holes + wedge)


def cylinder_on_cube(occ):
    """Two solids that touch and share nothing: a cube of 20 and a cylinder of radius 6, 12 high, in the middle of its top."""
    occ.addBox(0, 0, 0, 20, 20, 20)
    occ.addCylinder(10, 10, 20, 0, 0, 12, 6)


def rod(occ):
    """A quarter of a connecting rod, cut at its planes of symmetry y = 0 and z = 0: eyes of radius 20 and 12 around bores of 12 and 7, 60 apart, a
    shank of 14 with fillets of 6, 10 thick."""
    eyes = [(3, occ.addCylinder(0, 0, -5, 0, 0, 10, 20)), (3, occ.addCylinder(60, 0, -5, 0, 0, 10, 12))]
    whole = occ.fuse([(3, occ.addBox(0, -7, -5, 60, 14, 10))], eyes)[0]
    corners = [curve for x in (math.sqrt(20 ** 2 - 7 ** 2), 60 - math.sqrt(12 ** 2 - 7 ** 2)) for y in (-7, 7)
               for _, curve in occ.getEntitiesInBoundingBox(x - 0.1, y - 0.1, -5.1, x + 0.1, y + 0.1, 5.1, 1)]
    whole = occ.fillet([whole[0][1]], corners, [6])
    whole = occ.cut(whole, [(3, occ.addCylinder(0, 0, -6, 0, 0, 12, 12)), (3, occ.addCylinder(60, 0, -6, 0, 0, 12, 7))])[0]
    occ.intersect(whole, [(3, occ.addBox(-30, 0, 0, 120, 30, 10))])


def tee(occ):
    """A pipe of 24 around a bore of 18, 60 long, with a branch of 18 around a bore of 12."""
    outside = occ.fuse([(3, occ.addCylinder(-30, 0, 0, 60, 0, 0, 12))], [(3, occ.addCylinder(0, 0, 0, 0, 0, 30, 9))])[0]
    occ.cut(outside, [(3, occ.addCylinder(-31, 0, 0, 62, 0, 0, 9)), (3, occ.addCylinder(0, 0, 0, 0, 0, 31, 6))])


def cover(occ):
    """A block of 60 x 40 x 16 with a bore of 20; all edges at its sides and on its top are rounded by 5, but for the bore's."""
    block = occ.addBox(0, 0, 0, 60, 40, 16)
    occ.synchronize()
    edges = [edge for _, edge in occ.getEntities(1) if occ.getBoundingBox(1, edge)[5] > 15]
    whole = occ.fillet([block], edges, [5])
    occ.cut(whole, [(3, occ.addCylinder(30, 20, -1, 0, 0, 20, 10))])


def main():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    for name, make in (("piston.step", piston), ("bracket.step", bracket), ("cylinder_on_cube.step", cylinder_on_cube), ("rod.step", rod),
                       ("tee.step", tee), ("cover.step", cover)):
        make(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        gmsh.write(os.path.join(sys.argv[1], name))
        gmsh.clear()


if __name__ == "__main__":
    main()
