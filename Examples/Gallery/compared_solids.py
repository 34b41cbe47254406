# SPDX-License-Identifier: BSD-3-Clause
"""A piston as curved tetrahedra and as a certified spline, both coloured by their distance from the part, with what `knotwork compare` says of them.

usage: compared_solids.py [--output DIR]
"""
import json
import os
import subprocess

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import _scene as scene
import cad_fit
import cad_fit_examples as drawing
from cad_hexahedra import CUTS, PART, SEEN_FROM
from cad_modification import PROGRAM

LARGEST = 0.05   # mm, of the colours
VOLUME = 131458.91  # mm3, OpenCASCADE's integral: see the page of the parts


def run(folder, *words):
    """One job in the folder; its report."""
    report = os.path.join(folder, "compared_solids.json")
    subprocess.run([PROGRAM, *words, "--report", report, "--force", "--quiet"], check=True, cwd=folder)
    with open(report, encoding="utf-8") as file:
        return json.load(file)


def coloured(file):
    """The triangles of a boundary in colours of their absolute distances."""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(file)
    mesh = scene.updated(reader).GetOutput()
    distance = vtk_to_numpy(mesh.GetPointData().GetArray("Distance"))
    distance[:] = np.abs(distance)
    item = scene.actor(mesh, (1, 1, 1), lighting=True)
    colours = vtkLookupTable()
    colours.SetHueRange(0.6, 0.0)
    colours.SetSaturationRange(0.35, 0.9)
    colours.SetValueRange(0.95, 0.85)
    colours.SetRange(0, LARGEST)
    colours.Build()
    mapper = item.GetMapper()
    mapper.ScalarVisibilityOn()
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("Distance")
    mapper.SetLookupTable(colours)
    mapper.UseLookupTableScalarRangeOn()
    return item


def edges(folder, samples=9):
    """The curved edges of the quadratic tetrahedra on the boundary, as lines."""
    grid = knotwork.read(os.path.join(folder, "compared_mesh.vtu"))
    points = vtk_to_numpy(grid.GetPoints().GetData())
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 10)
    middles = {}
    for a, m, b in ((0, 4, 1), (1, 5, 2), (2, 6, 0), (0, 7, 3), (1, 8, 3), (2, 9, 3)):
        middles.update({(min(c[a], c[b]), max(c[a], c[b])): c[m] for c in cells})
    reader = vtkXMLPolyDataReader()  # corners have the numbers that they have in the cells
    reader.SetFileName(os.path.join(folder, "compared_edges.vtp"))
    triangles = vtk_to_numpy(scene.updated(reader).GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
    t = np.linspace(0, 1, samples)[:, None]
    ends = {(min(c[k], c[k - 1]), max(c[k], c[k - 1])) for c in triangles for k in range(3)}
    return scene.polylines([(1 - t) * (1 - 2 * t) * points[a] + 4 * t * (1 - t) * points[middles[a, b]] + t * (2 * t - 1) * points[b]
                            for a, b in sorted(ends)])


def main():
    folder = os.path.abspath(scene.output_folder())
    seconds = {"spline": 0.0, "mesh": 0.0}
    for kind, words in (
            ("spline", ("cadmodify", PART, *CUTS, "--output", "compared_piston.brep")),
            ("spline", ("hexes", "compared_piston.brep", "--edge-length", "6", "--output", "compared_hexes.vtu")),
            ("spline", ("cadfit", "compared_hexes.vtu", "--target", PART, "--degree", "2", "--output", "compared_spline.vtu")),
            ("mesh", ("boundary", PART, "--chordal-tolerance", "1e-3", "--output", "compared_surface.vtp")),
            ("mesh", ("remesh", "compared_surface.vtp", "--size", "6", "--output", "compared_triangles.vtp")),
            ("mesh", ("tetrahedralize", "compared_triangles.vtp", "--target", PART, "--order", "2", "--boundary", "compared_edges.vtp", "--output", "compared_mesh.vtu"))):
        seconds[kind] += run(folder, *words)["cpu_seconds"]
    numbers = run(folder, "compare", "compared_spline.vtu", "compared_mesh.vtu", "--reference", PART, "--chordal-tolerance", "2e-4",
                  "--spline-boundary", "compared_spline.vtp", "--mesh-boundary", "compared_mesh.vtp", "--output", "compared_solids.csv")
    lines = {"spline": drawing.lines_of(drawing.element_lines(cad_fit.boundary(knotwork.read(os.path.join(folder, "compared_spline.vtu")))), 1),
             "mesh": drawing.lines_of(edges(folder), 1)}
    panels = []
    for k, (kind, title) in enumerate((("mesh", "tetrahedra of order 2"), ("spline", "one spline of degree 2"))):
        number = {name: numbers[f"{kind}_{name}"] for name in ("elements", "functions", "valid_elements", "largest_distance", "rms_to_reference", "volume")}
        text = (f"{title}: {number['elements']} elements, {number['valid_elements']} proved valid, {number['functions']} functions\n"
                f"at most {number['largest_distance']:.3f} mm off, {number['rms_to_reference']:.4f} root mean square; volume {abs(number['volume'] / VOLUME - 1):.0e} off, {seconds[kind]:.1f} s of one core")
        print(text)
        items = [coloured(os.path.join(folder, f"compared_{kind}.vtp")), lines[kind]]
        panels.append(drawing.seen(items, k, 2, text, SEEN_FROM, (0, 0, 30), 0.9))
    panels[0].AddActor(scene.label(f"distance from the part: blue 0, red {LARGEST} mm and more", 0.04, 0.95, 14))
    scene.save(panels, os.path.join(folder, "compared_solids.png"), (1500, 750))


if __name__ == "__main__":
    main()
