# SPDX-License-Identifier: BSD-3-Clause
"""Hexahedra of a machine part with extraordinary edges, fitted to the part's triangles: the mesh and the spline of degree 2, every
element of which is proved valid (cad_fit_volumes.png).

The folder of the meshes is named by KNOTWORK_UNSTRUCTURED_MESHES.

usage: cad_fit_volumes.py [--output DIR]
"""
import os

import _scene as scene
import cad_fit
import cad_fit_examples as drawing
import meshed_parts


def main():
    folder = scene.output_folder()
    mesh, target = meshed_parts.read("cmu_hepta.vtk"), meshed_parts.read("cmu_hepta_target.off")
    made = cad_fit.fit(mesh, target, Degree=2)
    text = {name: drawing.text_of(made, name) for name in ("Verdict", "Functions", "RmsDistance", "MeshRmsDistance")}
    spline = cad_fit.boundary(made.GetOutputDataObject(0))
    panels = []
    for k, (items, title) in enumerate((
            ([cad_fit.edged(target, drawing.PAPER)], f"target: {target.GetNumberOfCells()} triangles"),
            ([cad_fit.edged(mesh, drawing.PAPER)], f"mesh: {mesh.GetNumberOfCells()} hexahedra, {float(text['MeshRmsDistance']):.2f} off"),
            ([scene.actor(cad_fit.drawn(spline), scene.COLOURS[0], lighting=True), drawing.lines_of(drawing.element_lines(spline), 1)],
             f"spline, {text['Verdict']}: {text['Functions']} functions, {float(text['RmsDistance']):.2f} off"))):
        panels.append(drawing.seen(items, k, 3, title, (300, -400, 330), mesh.GetCenter(), 1.04))
    scene.save(panels, os.path.join(folder, "cad_fit_volumes.png"), (1500, 480))


if __name__ == "__main__":
    main()
