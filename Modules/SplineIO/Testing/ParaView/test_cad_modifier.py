# SPDX-License-Identifier: BSD-3-Clause
"""A face of a STEP file mended and split by the source in ParaView."""
import os

import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import CADModifier, OutputPort  # noqa: E402


def test_faces_are_mended():
    made = CADModifier(FileName=knotwork_testing.data(os.path.join("Hostile", "sound.step")), Operations="heal 0.001")
    made.UpdatePipeline()
    # one face, which has no neighbour: a warning says so
    faces = made.GetClientSideObject().GetOutputDataObject(2).GetCellData().GetArray("FaceId")
    assert faces.GetRange() == (0.0, 0.0) and OutputPort(made, 2).GetDataInformation().GetNumberOfCells() > 0
    table = made.GetClientSideObject().GetOutputDataObject(3)
    assert table.GetNumberOfRows() == 1 and table.GetValueByName(0, "Operation").ToString() == "heal"
    assert "4 edges of one face only" in table.GetValueByName(0, "Unmended").ToString()


knotwork_testing.main(globals())
