# SPDX-License-Identifier: BSD-3-Clause
"""What Python and pvbatch tests share: folders, pictures, a runner.

A test script defines functions test_*() and ends in `knotwork_testing.main(globals())`.
"""
import json
import os
import subprocess
import sys
import tarfile
import time
import traceback

DATA_DIR = os.environ["KNOTWORK_DATA_DIR"]
BASELINE_DIR = os.environ["KNOTWORK_BASELINE_DIR"]
OUTPUT_DIR = os.environ["KNOTWORK_OUTPUT_DIR"]
BIN_DIR = os.environ["KNOTWORK_BIN_DIR"]
SKIPPED = 77  # exit status, see knotwork_add_command_test
PROGRAM = os.path.join(BIN_DIR, "knotwork")


def data(name):
    """Path of a file below Testing/Data."""
    return os.path.join(DATA_DIR, name)


def output(name):
    """Path of a file that the test may write; its folder exists."""
    path = os.path.join(OUTPUT_DIR, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    return path


def compare_image(name):
    """Compares output(name + '.png') with the baseline of that name; AssertionError says what differs."""
    done = subprocess.run(
        [os.path.join(BIN_DIR, "CompareImages"), output(name + ".png"), os.path.join(BASELINE_DIR, name + ".png")],
        stderr=subprocess.PIPE, text=True)
    assert done.returncode == 0, done.stderr.strip()


def render_and_compare(renderer, name, size=300):
    """Renders a vtkRenderer off screen on white, without multisampling, and compares the picture with its baseline."""
    import vtkmodules.vtkRenderingFreeType  # noqa: F401
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
    from vtkmodules.vtkIOImage import vtkPNGWriter
    from vtkmodules.vtkRenderingCore import vtkRenderWindow, vtkWindowToImageFilter

    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(size, size)
    renderer.SetBackground(1, 1, 1)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetInputConnection(grab.GetOutputPort())
    writer.SetFileName(output(name + ".png"))
    writer.Write()
    compare_image(name)


class Errors:
    """Collects the error messages of an algorithm and of its executive: `with Errors(filter) as errors: ...`."""

    def __init__(self, algorithm):
        self.sources = [algorithm, algorithm.GetExecutive()]
        self.messages = []

    def __enter__(self):
        def record(caller, event, text=""):
            self.messages.append(text)

        record.CallDataType = "string0"
        self.tags = [(source, source.AddObserver("ErrorEvent", record)) for source in self.sources]
        return self.messages

    def __exit__(self, *ignored):
        for source, tag in self.tags:
            source.RemoveObserver(tag)


def load_plugin():
    """Loads the Knotwork plugin into pvbatch."""
    from paraview.simple import LoadPlugin

    LoadPlugin(os.environ["KNOTWORK_PLUGIN"], remote=False, ns=sys.modules["paraview.simple"].__dict__)


def save_and_compare(view, name, size=300):
    """Saves a ParaView render view on white, without axes, and compares the picture with its baseline."""
    from paraview.simple import SaveScreenshot

    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Single Color"
    view.Background = [1, 1, 1]
    view.MultiSamples = 0
    view.UseFXAA = 0
    view.ViewSize = [size, size]
    SaveScreenshot(output(name + ".png"), view, ImageResolution=[size, size], TransparentBackground=0)
    compare_image(name)


def run_program(*arguments, timeout=120, folder=None, limit=None):
    """Runs the program `knotwork`, in the folder if one is given; the result has returncode, stdout and stderr.

    limit: called in its process before it runs. Programs with sanitizers take longer: the environment's KNOTWORK_PATIENCE times the timeout (seconds).
    """
    timeout *= float(os.environ.get("KNOTWORK_PATIENCE", "1"))
    return subprocess.run([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          errors="replace", timeout=timeout, cwd=folder, preexec_fn=limit)


class Files:
    """The files of a test, in a folder of its own: runs the program there."""

    MESHES = "/usr/share/doc/libcgal-dev/data.tar.gz"  # of Debian's libcgal-demo

    def __init__(self, name, timeout=120):
        self.folder = os.path.dirname(output(name + "/files"))
        self.timeout = timeout

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *words, status=0, limit=None):
        """What run_program gives; AssertionError for another exit status."""
        done = run_program(*words, folder=self.folder, timeout=self.timeout, limit=limit)
        assert done.returncode == status, (words, done.stderr)
        return done

    def refused(self, *words, said=(), limit=None):
        """The job fails with one line that has these words, and leaves the folder as it was."""
        before = sorted(os.listdir(self.folder))
        text = self.run(*words, status=1, limit=limit).stderr
        assert len(text.splitlines()) == 1 and all(word in text for word in said), text
        assert sorted(os.listdir(self.folder)) == before, words

    def report(self, *words):
        """What the job says in its report."""
        self.run(*words, "--report", "report.json", "--force")
        with open(self.path("report.json"), encoding="utf-8") as file:
            return json.load(file)

    def unpack_meshes(self, *names):
        """Copies NAME.off of libcgal-demo; leaves the test as skipped without that package."""
        if not os.path.exists(self.MESHES):
            skip(f"{self.MESHES} is missing; install the package libcgal-demo")
        with tarfile.open(self.MESHES) as archive:
            for name in names:
                with open(self.path(name + ".off"), "wb") as file:
                    file.write(archive.extractfile(f"data/meshes/{name}.off").read())


def skip(reason):
    """Leaves at once; ctest lists the test as skipped."""
    print("skipped:", reason)
    sys.stdout.flush()
    os._exit(SKIPPED)


def main(namespace):
    """Runs every test_* function and leaves with status 1 when one fails or when there is none."""
    tests = [(name, item) for name, item in namespace.items() if name.startswith("test_") and callable(item)]
    failed = []
    for name, test in tests:
        begin = time.monotonic()
        try:
            test()
            print(f"passed {name} in {time.monotonic() - begin:.1f} s")
        except BaseException:  # a test that calls exit() has failed too
            traceback.print_exc()
            print("FAILED", name)
            failed.append(name)
        sys.stdout.flush()
        sys.stderr.flush()
    print(f"{len(tests) - len(failed)} of {len(tests)} passed")
    sys.stdout.flush()
    # At once: neither pvbatch nor the order in which Python drops pipelines may change the status.
    os._exit(1 if failed or not tests else 0)
