# SPDX-License-Identifier: BSD-3-Clause
"""An exact disc of five rational patches, refined around a point of its rim, as polygons that deviate from it by no more
than 1e-3 of its size.

usage: refine_and_tessellate.py OUTPUT.vtp
"""
import sys

import knotwork
from vtkmodules.vtkCommonDataModel import vtkSphere
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

if len(sys.argv) != 2:
    sys.exit(__doc__)

disc = knotwork.vtkSplineSource()
disc.SetShapeName("Disc")
disc.SetElements(2, 2, 1)

where = vtkSphere()
where.SetCenter(0.75, 0.66, 0.0)
where.SetRadius(0.15)
refine = knotwork.vtkSplineRefine()  # the map stays what it is
refine.SetInputConnection(disc.GetOutputPort())
refine.SetMode(refine.IMPLICIT_FUNCTION)
refine.SetImplicitFunction(where)
refine.SetNumberOfRefinements(3)

tessellate = knotwork.vtkSplineTessellate()
tessellate.SetInputConnection(refine.GetOutputPort())
tessellate.SetChordalTolerance(1e-3)

writer = vtkXMLPolyDataWriter()
writer.SetInputConnection(tessellate.GetOutputPort())
writer.SetFileName(sys.argv[1])
writer.SetDataModeToBinary()  # which every ParaView reads
if not writer.Write() or tessellate.GetErrorCode():
    sys.exit(1)  # VTK has said why

mesh = tessellate.GetOutputDataObject(0)
bound = mesh.GetFieldData().GetArray("ChordalBound").GetValue(0)
print(f"{mesh.GetNumberOfCells()} cells, nowhere farther from the disc than {bound:.3g}")
