# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView the script for blender is found beside the plugin: a stand-in that returns the triangles is refused with that reason."""
import os

import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import QuadRemesher, Sphere  # noqa: E402

PROGRAM = knotwork_testing.output("quad_remesher_paraview/blender")


def test_the_refusal_of_a_stand_in():
    with open(PROGRAM, "w", encoding="utf-8") as stream:
        stream.write('#!/bin/sh\nwhile [ "$1" != -- ]; do [ "$1" != --python ] || head -c 1 "$2" > /dev/null || exit 5; shift; done\ncp "$2" "$3"\n')
    os.chmod(PROGRAM, 0o755)
    os.environ["PATH"] = os.path.dirname(PROGRAM) + os.pathsep + os.environ["PATH"]
    remesher = QuadRemesher(Input=Sphere(), Faces=100, Way="Program")
    filter = remesher.GetClientSideObject()
    with knotwork_testing.Errors(filter) as errors:
        remesher.UpdatePipeline()
    assert errors[0].count("the triangles came back as they are") == 6, errors


knotwork_testing.main(globals())
