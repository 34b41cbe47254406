# SPDX-License-Identifier: BSD-3-Clause
"""A face of a STEP file as a grid."""
import os

import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import CADQuads, OutputPort  # noqa: E402


def test_one_face():
    quads = CADQuads(FileName=knotwork_testing.data(os.path.join("Hostile", "sound.step")), MinimumDivisions=4, EdgeLength=1e6)
    quads.UpdatePipeline()
    assert OutputPort(quads, 0).GetDataInformation().GetNumberOfCells() == 16
    numbers = quads.GetClientSideObject().GetOutputDataObject(1)
    assert numbers.GetValueByName(0, "MappedFaces").ToInt() == 1


knotwork_testing.main(globals())
