# SPDX-License-Identifier: BSD-3-Clause
"""A face of a STEP file mended and split by the source in ParaView."""
import os

import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import CADModifier, OutputPort  # noqa: E402


def test_faces_are_mended():
    made = CADModifier(FileName=knotwork_testing.data(os.path.join("Hostile", "sound.step")), Operations="heal 0.001")
    made.UpdatePipeline()
    assert OutputPort(made, 0).GetDataInformation().GetNumberOfCells() == 1
    table = made.GetClientSideObject().GetOutputDataObject(3)
    assert table.GetNumberOfRows() == 1 and table.GetValueByName(0, "Operation").ToString() == "heal"


knotwork_testing.main(globals())
