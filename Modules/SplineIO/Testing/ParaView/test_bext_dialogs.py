# SPDX-License-Identifier: BSD-3-Clause
"""BEXT in ParaView's File > Open and Save Data: text and JSON, told apart from the JSON of a boundary."""
import os

import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import OpenDataFile, SaveData  # noqa: E402


def opened(file):
    source = OpenDataFile(file)
    source.UpdatePipeline()
    return source, source.GetXMLLabel(), source.GetDataInformation(0).GetNumberOfCells()


def test_files_are_opened_by_what_they_hold():
    for name in ("by_hand.bext", "by_hand_bext.json"):
        _, label, cells = opened(knotwork_testing.data("SplineIO/" + name))
        assert (label, cells) == ("BEXT Reader", 2), (name, label, cells)
    _, label, cells = opened(knotwork_testing.data("SplineIO/by_hand_curves.json"))
    assert label == "Domain Boundary Reader" and cells > 0, (label, cells)


def test_what_is_saved_is_opened_again():
    source, _, _ = opened(knotwork_testing.data("SplineIO/by_hand.bext"))
    texts = []
    for name in ("saved.bext", "saved.json", "again.bext"):
        file = knotwork_testing.output(name)
        SaveData(file, proxy=source)
        assert os.path.getsize(file) > 0, name
        source, label, cells = opened(file)
        assert (label, cells) == ("BEXT Reader", 2), (name, label, cells)
        with open(file) as stream:
            texts.append(stream.read())
    assert texts[0] == texts[2] and texts[0].startswith("B E X T 2.0") and texts[1].startswith("{")


knotwork_testing.main(globals())
