# SPDX-License-Identifier: BSD-3-Clause
"""While a function runs: other Python threads go on, progress is told, Ctrl-C and progress abort, several threads may run functions."""
import os
import signal
import threading
import time

import knotwork as kw
import knotwork_testing
import numpy as np


def cloud(n):
    rng = np.random.default_rng(3)
    xy = rng.random((n, 2))
    return kw.points(np.column_stack([xy, np.sin(20 * xy[:, 0]) * np.cos(17 * xy[:, 1]) + 1e-3 * rng.random(n)]))


LARGE = cloud(300000)


def slow(**options):
    return kw.fit(LARGE, tolerance=6e-4, threads=1, **options)


def test_other_threads_go_on():
    ticks, ended = [], threading.Event()

    def count():
        while not ended.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.002)

    counter = threading.Thread(target=count)
    counter.start()
    begin = time.perf_counter()
    slow()
    end = time.perf_counter()
    ended.set()
    counter.join()
    inside = [each for each in ticks if begin < each < end]
    # with the lock kept there would be none but between the calls
    assert max(np.diff([begin, *inside, end])) < 0.5 * (end - begin), (len(inside), end - begin)


def test_progress_is_told_and_ascends():
    told = []
    slow(progress=told.append)
    assert told[0] >= 0 and told[-1] <= 1 and told == sorted(told) and len(told) > 3, told


def test_progress_aborts():
    try:
        slow(progress=lambda share: share < 0.1)
    except kw.Error as fault:
        assert fault.code == "Aborted", fault.code
    else:
        raise AssertionError("not aborted")


def test_what_progress_raises_is_raised():
    def fail(share):
        raise KeyError("mine")

    try:
        slow(progress=fail)
    except KeyError as fault:
        assert fault.args == ("mine",)
    else:
        raise AssertionError("not raised")


def test_ctrl_c_aborts():
    timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
    before = signal.getsignal(signal.SIGINT)
    timer.start()
    try:
        for _ in range(100):  # until the signal comes
            slow()
    except KeyboardInterrupt:
        pass
    else:
        raise AssertionError("not interrupted")
    finally:
        timer.join()
    assert signal.getsignal(signal.SIGINT) is before


def test_threads_have_the_results_of_one():
    clouds = [cloud(5000 * (1 + i)) for i in range(6)]
    found = [None] * len(clouds)

    def work(i):
        found[i] = kw.fit(clouds[i], tolerance=0.01, threads=1).contour([0.5]).points.copy()

    threads = [threading.Thread(target=work, args=(i,)) for i in range(len(clouds))]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    for i, each in enumerate(clouds):
        assert np.array_equal(found[i], kw.fit(each, tolerance=0.01, threads=1).contour([0.5]).points)


def test_pictures():
    surface = kw.fit(LARGE, tolerance=0.01)
    picture = surface._repr_png_()
    assert picture[:8] == b"\x89PNG\r\n\x1a\n" and len(picture) > 5000
    assert surface._repr_png_() == picture
    validated = kw.validate(kw.source("disc"))
    name = "knotwork-validated.png"
    validated.plot(file=name, scalars="JacobianVerdict", edges=True, size=(320, 240))
    assert os.path.getsize(name) > 1000
    os.remove(name)


def test_only_windows_need_a_display():
    before = os.environ.get("DISPLAY")
    os.environ["DISPLAY"] = ":no-such-display"
    try:
        assert kw.picture(kw.source("square"))[:4] == b"\x89PNG"
        kw.plot(kw.source("square"))
    except kw.Error as fault:
        assert "xvfb-run" in fault.remedy
    else:
        raise AssertionError("drawn without a display")
    finally:
        os.environ["DISPLAY"] = before or ""


knotwork_testing.main(globals())
