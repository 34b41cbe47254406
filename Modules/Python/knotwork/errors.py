# SPDX-License-Identifier: BSD-3-Clause
"""What the functions of the package raise."""
from ._properties import CODES

USER_ERROR = 40000  # vtkErrorCode::UserError


class Error(ValueError):
    """A filter, reader or writer that has no result.

    code: kind of the failure, one of knotwork.errors.CODES, such as "OutsideDomain"; "LibraryError" of VTK's own failures.
    message: the whole sentence.
    place: what the sentence says of where and why.
    remedy: what it says behind its last semicolon, mostly what to do; empty without one.
    """

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code
        self.message = message
        detail = message.split(": ", 1)[-1]
        self.place, _, self.remedy = detail.rpartition("; ") if "; " in detail else (detail, "", "")

    def __reduce__(self):
        return type(self), (self.code, self.message)


class FileError(Error, OSError):
    """A file that the system does not let read or write."""


def make_error(number, message):
    """number: of vtkAlgorithm.GetErrorCode()."""
    place = number - USER_ERROR
    code = CODES[place - 1] if 0 < place <= len(CODES) else "LibraryError"
    return (FileError if code == "FileError" else Error)(code, message)
