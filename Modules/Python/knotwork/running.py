# SPDX-License-Identifier: BSD-3-Clause
"""Runs algorithms: errors are raised, warnings warned, Ctrl-C aborts, other Python threads go on."""
import re
import signal
import threading
import warnings

from . import _update
from .errors import make_error

MESSAGE = re.compile(r"(?:ERROR|Warning): In .*?\n\w+ \(0x[0-9a-f]+\): (.*)", re.S)


class _Watch:
    """What an algorithm says while it runs."""

    def __init__(self, algorithm, progress):
        self.algorithm = algorithm
        self.progress = progress
        self.errors, self.warnings = [], []
        self.interrupted = False
        self.failure = None

    def hear(self, _, event, text):
        found = MESSAGE.match(text)
        sentence = " ".join((found[1] if found else text).split())
        (self.errors if event == "ErrorEvent" else self.warnings).append(sentence)

    hear.CallDataType = "string0"

    def step(self, caller, _):
        """Signals of Python are handled here, too: this is the only Python that runs meanwhile."""
        if self.interrupted or self.failure:
            caller.SetAbortExecute(True)
        elif self.progress:
            try:
                if self.progress(caller.GetProgress()) is False:
                    caller.SetAbortExecute(True)
            except BaseException as failure:  # an observer must not raise; it is raised when the algorithm has ended
                self.failure = failure
                caller.SetAbortExecute(True)

    def interrupt(self, *_):
        self.interrupted = True
        self.algorithm.SetAbortExecute(True)


def run(algorithm, progress=None):
    """Brings it up to date. Raises knotwork.Error, or KeyboardInterrupt after Ctrl-C.

    progress: called with the share that is done, 0 to 1; what it raises is raised; the algorithm is aborted where it returns False."""
    watch = _Watch(algorithm, progress)
    heard = [algorithm, algorithm.GetExecutive()]
    observed = [(each, each.AddObserver(event, watch.hear)) for each in heard for event in ("ErrorEvent", "WarningEvent")]
    observed.append((algorithm, algorithm.AddObserver("ProgressEvent", watch.step)))
    catches = threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGINT) is not None
    before = signal.signal(signal.SIGINT, watch.interrupt) if catches else None
    try:
        _update.update(algorithm)
    finally:
        if catches:
            signal.signal(signal.SIGINT, before)
        for each, tag in observed:
            each.RemoveObserver(tag)
    if watch.failure:
        raise watch.failure
    if watch.interrupted:
        raise KeyboardInterrupt
    if watch.errors or algorithm.GetErrorCode():  # an abort is no error of VTK's
        raise make_error(algorithm.GetErrorCode(), watch.errors[0] if watch.errors else "aborted on request")
    for sentence in watch.warnings:
        warnings.warn(sentence, stacklevel=4)
