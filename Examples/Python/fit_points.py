# SPDX-License-Identifier: BSD-3-Clause
"""usage: fit_points.py POINTS SURFACE [TOLERANCE]

Fits a spline surface to points (.xyz, .csv, .ply, .g2, .vtp) and writes it (.vtu or .g2). Points that are not there are made: a hill and
a cliff. Prints how the fit went on, and exits with 1 when a point is left outside the tolerance.
"""
import os
import sys

import knotwork
import numpy as np
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter


def make_points(file, n=20000):
    x, y = np.random.default_rng(1).random((2, n))
    z = np.exp(-30 * ((x - 0.3) ** 2 + (y - 0.6) ** 2)) + 0.2 * np.tanh((y - 0.4 - 0.1 * np.sin(6 * x)) / 0.02)
    np.savetxt(file, np.c_[x, y, z], fmt="%.17g")


def main(points, surface, tolerance=0.005):
    if not os.path.exists(points):
        make_points(points)
    reader = knotwork.vtkPointCloudReader()
    reader.SetFileName(points)
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputConnection(reader.GetOutputPort())
    fit.SetTolerance(float(tolerance))
    fit.Update()
    table = fit.GetOutputDataObject(2)
    for row in range(table.GetNumberOfRows()):
        values = [table.GetValueByName(row, name).ToString() for name in ("Iteration", "Functions", "MaxError", "PointsOutside")]
        print("iteration {}: {} functions, largest distance {}, {} points outside".format(*values))
    writer = knotwork.vtkGoToolsG2Writer() if surface.endswith(".g2") else vtkXMLUnstructuredGridWriter()
    writer.SetInputConnection(0, fit.GetOutputPort(0))
    writer.SetFileName(surface)
    written = writer.Write() == 1
    outside = table.GetValueByName(table.GetNumberOfRows() - 1, "PointsOutside").ToInt()
    return 0 if written and fit.GetErrorCode() == 0 and outside == 0 else 1


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:4]))
