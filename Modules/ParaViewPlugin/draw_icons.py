#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""usage: draw_icons.py FOLDER NAME...: an icon for each proxy of ParaView's menus, FOLDER/NAME.svg of 24 x 24.

An icon is what comes out (a curve, a surface, a solid, triangles, quadrilaterals, hexahedra, points) under the sign of what is done; ICONS says
both, and others are a plain surface."""
import os
import sys

BLUE, DARK, GREEN, RED, ORANGE, PALE = "#5b8db8", "#20415c", "#3a8f3a", "#c0392b", "#e69138", "#cfe0ee"


def path(d, stroke=DARK, fill="none", width=1.4):
    return f'<path d="{d}" stroke="{stroke}" fill="{fill}" stroke-width="{width}" stroke-linecap="round" stroke-linejoin="round"/>'


def dots(places, color=DARK, radius=1.5):
    return "".join(f'<circle cx="{x}" cy="{y}" r="{radius}" fill="{color}"/>' for x, y in places)


PATCH = "M3 17 C7 20 12 14 18 17 C18 12 20 9 20 5 C15 3 11 8 6 5 C6 9 3 12 3 17 Z"
FLAT = "M3 5 L20 5 L20 18 L3 18 Z"
BOX = "M3 9 L9 4 L21 4 L21 14 L15 19 L3 19 Z"
BOX_EDGES = "M3 9 L15 9 L15 19 M15 9 L21 4"
THINGS = {
    "curve": path("M3 18 C6 2 14 22 20 5", BLUE, width=2.4),
    "surface": path(PATCH, fill=BLUE) + path("M4.5 11 C9 13 13 9 19 11 M11 17.2 C11 12 13 10 12.5 5.2", PALE, width=1),
    "net": path(PATCH, BLUE, PALE, 1) + path("M3 17 L9 20 L18 17 L21 10 L20 5 L13 3 L6 5 L3 11 Z M9 20 L11 11 L13 3 M3 11 L11 11 L21 10", width=1)
    + dots([(3, 17), (9, 20), (18, 17), (21, 10), (20, 5), (13, 3), (6, 5), (3, 11), (11, 11)], RED, 1.3),
    "domain": path(FLAT, fill=PALE) + path("M11.5 5 L11.5 18 M3 11.5 L20 11.5 M11.5 8.2 L20 8.2 M15.7 5 L15.7 11.5", width=1),
    "solid": path(BOX, fill=BLUE) + path(BOX_EDGES, PALE, width=1.2),
    "hexahedra": path(BOX, fill=PALE) + path(BOX_EDGES + "M9 9 L9 19 M3 14 L15 14 L21 9 M9 9 L15 4 M18 6.5 L18 16.5 M6 6.5 L18 6.5", width=1),
    "quads": path(PATCH, fill=PALE) + path("M4.5 11 C9 13 13 9 19 11 M11 17.2 C11 12 13 10 12.5 5.2", width=1),
    "triangles": path("M3 18 L8 5 L15 9 L21 5 L19 17 L11 20 Z", fill=PALE) + path("M3 18 L15 9 M8 5 L3 18 M15 9 L11 20 M15 9 L19 17", width=1),
    "points": dots([(4, 17), (7, 9), (10, 14), (12, 6), (15, 11), (18, 5), (19, 15), (14, 18), (5, 5)]),
    "tetrahedra": path("M3 17 L11 3 L21 14 L12 21 Z", fill=PALE) + path("M11 3 L12 21 M3 17 L21 14", width=1),
}
SIGNS = {
    "": "",
    "check": path("M12 17 L15.5 21 L22 12", "white", width=5) + path("M12 17 L15.5 21 L22 12", GREEN, width=2.6),
    "split": path("M17.5 12 L17.5 22 M12.5 17 L22.5 17", "white", width=4.4) + path("M17.5 12 L17.5 22 M12.5 17 L22.5 17", GREEN, width=2.2),
    "join": path("M12 17 L22 17 M15 14 L12 17 L15 20 M19 14 L22 17 L19 20", "white", width=4) + path("M12 17 L22 17 M15 14 L12 17 L15 20 M19 14 L22 17 L19 20", GREEN, width=1.8),
    "measure": path("M12 20 L22 20 M12 17 L12 23 M22 17 L22 23", "white", width=4) + path("M12 20 L22 20 M12 17 L12 23 M22 17 L22 23", RED, width=1.8),
    "cut": path("M4 21 L21 4", "white", width=4) + path("M4 21 L21 4", RED, width=1.8),
    "find": '<circle cx="15" cy="15" r="4" fill="white" stroke="#c0392b" stroke-width="1.8"/>' + path("M18 18 L22 22", RED, width=2.4),
    "move": path("M10 18 L21 18 M17 14 L21 18 L17 22", "white", width=4.4) + path("M10 18 L21 18 M17 14 L21 18 L17 22", ORANGE, width=2.2),
    "fit": dots([(3.5, 15), (8, 16.5), (11, 12), (15, 14.5), (19, 9), (8, 8.5), (14, 6)], RED, 1.4),
    "lines": path("M4 8 C9 5 15 9 20 7 M4 12 C9 9 15 13 20 11 M3 16 C9 13 15 17 19 15", RED, width=1.3),
    "mend": path("M13 22 L21 14 M19 12 A3 3 0 1 0 23 16", "white", width=4.6) + path("M13 22 L21 14 M19 12 A3 3 0 1 0 23 16", ORANGE, width=2.4),
    "solve": path("M14 13 L22 13 L17 17.5 L22 22 L14 22", "white", width=4.6) + path("M14 13 L22 13 L17 17.5 L22 22 L14 22", RED, width=2),
    "peak": dots([(12, 7)], RED, 2.4) + dots([(16, 15)], GREEN, 2.4),
    "trim": path("M11 5 A6 6 0 1 0 11.1 5 Z", RED, width=1.8),
    "corner": path("M6 5 L6 17 L20 17", RED, width=2.2),
    "grow": path("M5 20 L5 9 M2 12 L5 8.5 L8 12", "white", width=4) + path("M5 20 L5 9 M2 12 L5 8.5 L8 12", ORANGE, width=2),
}
ICONS = {
    "KnotworkSplineSource": ("solid", ""), "CADQuads": ("quads", "corner"), "CADHexahedra": ("hexahedra", "corner"), "CADModifier": ("solid", "mend"),
    "UnstructuredSpline": ("quads", "split"), "MeshPatches": ("quads", "cut"), "SplineExtract": ("surface", "cut"), "SplineRefine": ("surface", "split"),
    "SplineControlNet": ("net", ""), "SplineParametricMesh": ("domain", ""), "SplineEvaluate": ("surface", "find"), "SplineTessellate": ("triangles", ""),
    "SplineWarp": ("surface", "move"), "CADFit": ("quads", "fit"), "DatumAlignment": ("triangles", "corner"), "DeviationMap": ("triangles", "measure"),
    "ElementCurving": ("tetrahedra", "move"), "RigidAlignment": ("triangles", "move"), "SweepToHexahedra": ("hexahedra", "grow"),
    "DomainParameterization": ("domain", "move"), "JacobianValidator": ("surface", "check"), "MeshFeatures": ("triangles", "lines"),
    "MeshParameterization": ("domain", "fit"), "SplineAnalysis": ("surface", "solve"), "SplineVersusMesh": ("tetrahedra", "solve"),
    "SplineContour": ("surface", "lines"), "SplineExtrema": ("surface", "peak"), "SplineCombine": ("curve", "join"), "SplinePointDistance": ("points", "measure"),
    "SplineStitch": ("surface", "join"), "SplineSurfaceFit": ("surface", "fit"), "SplineVolumeFit": ("solid", "fit"), "QuadRemesher": ("quads", "move"),
    "SurfaceRemesh": ("triangles", "split"), "SurfaceRepair": ("triangles", "mend"), "AnalyticModel": ("solid", "find"), "FaceIntersections": ("surface", "corner"),
    "SplineTrimToPoints": ("points", "trim"), "SurfaceRecognition": ("triangles", "find"), "TrimmedSurface": ("surface", "trim"),
    "TemplateMapping": ("curve", "move"), "SplineBoundary": ("triangles", "grow"), "TetGenMesher": ("tetrahedra", ""), "VolumeComparison": ("hexahedra", "measure"),
}


def draw(name):
    thing, sign = ICONS.get(name, ("surface", ""))
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="24" height="24" viewBox="0 0 24 24">{THINGS[thing]}{SIGNS[sign]}</svg>\n')


def main(folder, *names):
    os.makedirs(folder, exist_ok=True)
    for name in names:
        with open(os.path.join(folder, name + ".svg"), "w", encoding="utf-8") as file:
            file.write(draw(name))


if __name__ == "__main__":
    main(*sys.argv[1:])
