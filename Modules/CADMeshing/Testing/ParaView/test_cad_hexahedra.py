# SPDX-License-Identifier: BSD-3-Clause
"""A plate with a hole as hexahedra."""
import os

import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import CADHexahedra, OutputPort  # noqa: E402


def test_one_plate():
    hexes = CADHexahedra(FileName=knotwork_testing.data(os.path.join("Hostile", "sound.brep")))
    hexes.UpdatePipeline()
    numbers = hexes.GetClientSideObject().GetOutputDataObject(1)
    assert numbers.GetValueByName(0, "Verdict").ToString() == "valid"
    assert OutputPort(hexes, 0).GetDataInformation().GetNumberOfCells() == numbers.GetValueByName(0, "Hexahedra").ToInt() > 0


knotwork_testing.main(globals())
