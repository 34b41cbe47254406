# SPDX-License-Identifier: BSD-3-Clause
"""A pipeline of pvbatch in two processes, each of which reads and draws its pieces, makes the picture that one process makes, but for
the shading where pieces meet."""
import os
import shutil
import subprocess
import sys

import knotwork_testing


def draw(file, picture):
    """What a process does: patches of a solid, proved valid, tessellated and drawn."""
    knotwork_testing.load_plugin()
    import paraview.simple as simple
    reader = simple.XMLPartitionedUnstructuredGridReader(FileName=[file])
    proved = simple.JacobianValidator(Input=reader)
    drawn = simple.SplineTessellate(Input=proved, ChordalTolerance=1e-3)
    view = simple.CreateRenderView(ViewSize=[300, 300], Background=[1, 1, 1], UseColorPaletteForBackground=0, OrientationAxesVisibility=0)
    shown = simple.Show(drawn, view)
    simple.ColorBy(shown, ("CELLS", "JacobianMinLower"))
    shown.RescaleTransferFunctionToDataRange(False, True)
    shown.SetScalarBarVisibility(view, False)
    shown.Ambient, shown.Diffuse = 1, 0  # normals where pieces meet are those of each piece
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [3, -4, 3], [0, 0, 0], [0, 0, 1]
    simple.ResetCamera(view)
    simple.SaveScreenshot(picture, view, ImageResolution=[300, 300])


def test_the_same_picture():
    if not shutil.which("mpirun"):
        knotwork_testing.skip("there is no mpirun")
    grid, pieces = (knotwork_testing.output("picture_of_pieces" + ending) for ending in (".vtu", ".pvtu"))
    for words in (["source", "--shape", "solid-torus", "--output", grid], ["convert", grid, "--output", pieces, "--pieces", "2"]):
        subprocess.run([knotwork_testing.PROGRAM, *words, "--quiet", "--force"], check=True)
    pictures = []
    for start in ([], ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", "2"]):
        pictures.append(knotwork_testing.output(f"two_processes_{len(start)}.png"))
        command = [*start, "pvbatch", *(["--force-offscreen-rendering"]), os.path.abspath(__file__), pieces, pictures[-1]]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=240)
        assert done.returncode == 0 and os.path.exists(pictures[-1]), done.stdout
    compared = subprocess.run([os.path.join(knotwork_testing.BIN_DIR, "CompareImages"), *reversed(pictures)], stderr=subprocess.PIPE, text=True)
    assert compared.returncode == 0, compared.stderr


if len(sys.argv) > 1:
    draw(*sys.argv[1:3])
else:
    knotwork_testing.main(globals())
