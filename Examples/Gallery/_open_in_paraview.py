# SPDX-License-Identifier: BSD-3-Clause
"""usage: pvbatch _open_in_paraview.py PICTURE FACE...: opens FACE.vtp (triangles) and FACE_curves.vtu (trimming curves, which ParaView
draws as the Bezier curves they are) of each face in a view of its own."""
import sys

from paraview.simple import (AssignViewToLayout, CreateLayout, CreateRenderView, ResetCamera, SaveScreenshot, Show,
                             XMLPolyDataReader, XMLUnstructuredGridReader)

picture, faces = sys.argv[1], sys.argv[2:]
layout = CreateLayout("faces")
for k, face in enumerate(faces):
    view = CreateRenderView()
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Single Color"
    view.Background = [1, 1, 1]
    AssignViewToLayout(view, layout, k)
    surface = Show(XMLPolyDataReader(FileName=[face + ".vtp"]), view)
    surface.ColorArrayName = ["POINTS", ""]
    surface.DiffuseColor = [0.93, 0.55, 0.15]
    curves = Show(XMLUnstructuredGridReader(FileName=[face + "_curves.vtu"]), view)
    curves.ColorArrayName = ["POINTS", ""]
    curves.NonlinearSubdivisionLevel = 4
    curves.AmbientColor = curves.DiffuseColor = [0.1, 0.1, 0.2]
    curves.LineWidth = 3
    if k == 0:  # the box is open below
        view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [1, -1.4, 1], [0, 0, 0], [0, 0, 1]
    ResetCamera(view)
    view.CameraParallelProjection = 1
SaveScreenshot(picture, layout, ImageResolution=[1200, 600], TransparentBackground=0)
