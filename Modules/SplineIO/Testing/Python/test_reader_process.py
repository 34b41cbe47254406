# SPDX-License-Identifier: BSD-3-Clause
"""The programs that read foreign files: what they may, and that they end with who started them."""
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import time

import knotwork_testing

WORKERS = os.path.join(os.path.dirname(knotwork_testing.BIN_DIR), "libexec", "knotwork")
BYTES, SECONDS = 1 << 30, 20
LAST_PART = struct.pack("<Q", 2**64 - 1)


def path(name):
    return knotwork_testing.output("reader_process/" + name)


def waiting_file(name):
    """A file on whose content a reader waits for ever."""
    file = path(name)
    if os.path.exists(file):
        os.remove(file)
    os.mkfifo(file)
    return file


def options(program):
    return ["1", "0"] if program.endswith("cad") else []


def start(program, file, parent=None, limits=(BYTES, SECONDS), more=()):
    """A reader that has been told all, and the end of the socket on which it answers."""
    ours, its = (end.detach() for end in socket.socketpair())
    words = [str(parent or os.getpid()), *map(str, limits), file, *options(program)]

    def descriptors():
        os.dup2(its, 3)

    process = subprocess.Popen([os.path.join(WORKERS, program), *words], preexec_fn=descriptors, pass_fds=(3, *more),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(its)
    os.write(ours, LAST_PART)
    return process, ours


def status_of(process):
    """The table of /proc/<id>/status, once the process has opened the file and waits."""
    end = time.monotonic() + 30
    while time.monotonic() < end:
        with open(f"/proc/{process.pid}/status") as stream:
            table = dict(line.split(":", 1) for line in stream if ":" in line)
        if table["NoNewPrivs"].strip() == "1":
            with open(f"/proc/{process.pid}/limits") as stream:
                limits = {line[:26].strip(): line[26:].split() for line in stream}
            if str(BYTES) in limits["Max data size"]:  # the last that it sets
                return table, limits
        time.sleep(0.01)
    raise AssertionError("the reader has not given up its rights")


def each():
    return (("knotwork-read-vtk", "waiting.vtu"), ("knotwork-read-cad", "waiting.step"))


def test_it_may_read_and_nothing_else():
    for program, name in each():
        file = waiting_file(name)
        process, ours = start(program, file)
        try:
            table, limits = status_of(process)
            time.sleep(0.2)
            reading = 1 << 2  # CAP_DAC_READ_SEARCH
            for kind in ("CapEff", "CapPrm", "CapInh", "CapAmb"):
                assert int(table[kind], 16) & ~reading == 0, (kind, table[kind])
            assert limits["Max core file size"][:2] == ["0", "0"], limits
            assert limits["Max file size"][:2] == ["0", "0"], limits
            assert limits["Max cpu time"][:2] == [str(SECONDS), str(SECONDS + 1)], limits  # a signal that says so, then the end
            assert limits["Max data size"][:2] == [str(BYTES)] * 2, limits
        finally:
            process.kill()
            process.wait()
            os.close(ours)


def test_it_keeps_no_descriptor_of_its_parent():
    for program, name in each():
        file = waiting_file(name)
        ours, its = os.pipe()
        process, answers = start(program, file, more=(its,))
        os.close(its)
        try:
            status_of(process)
            os.set_blocking(ours, False)
            end = time.monotonic() + 10
            closed = None
            while closed is None and time.monotonic() < end:
                try:
                    closed = os.read(ours, 1) == b""
                except BlockingIOError:
                    time.sleep(0.01)
            assert closed, "somebody still holds the pipe"
            assert process.poll() is None
        finally:
            process.kill()
            process.wait()
            os.close(ours)
            os.close(answers)


def is_alive(process):
    try:
        with open(f"/proc/{process}/stat") as stream:
            return stream.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_it_ends_with_its_parent():
    script = ("import os, socket, struct, subprocess, sys, time\n"
              "ours, its = socket.socketpair()\n"
              "p = subprocess.Popen([sys.argv[1], str(os.getpid()), *sys.argv[2:]], preexec_fn=lambda: os.dup2(its.fileno(), 3),\n"
              "                     pass_fds=(3,), stdout=subprocess.DEVNULL)\n"
              "ours.sendall(struct.pack('<Q', 2**64 - 1))\n"
              "print(p.pid, flush=True)\ntime.sleep(60)\n")
    for program, name in each():
        file = waiting_file(name)
        parent = subprocess.Popen([sys.executable, "-c", script, os.path.join(WORKERS, program), str(BYTES), str(SECONDS), file,
                                   *options(program)], stdout=subprocess.PIPE, text=True)
        child = int(parent.stdout.readline())
        time.sleep(1)
        assert is_alive(child)
        parent.send_signal(signal.SIGKILL)
        parent.wait()
        end = time.monotonic() + 10
        while is_alive(child) and time.monotonic() < end:
            time.sleep(0.01)
        assert not is_alive(child)


def test_it_does_not_begin_without_its_parent():
    for program, name in each():
        process, ours = start(program, waiting_file(name), parent=1)
        assert process.wait(30) == 1
        os.close(ours)


def test_memory_and_time_are_limited():
    """Three million points are more than 60 MB of data and take more than no time at all."""
    file = path("many.vtk")
    count = 3000000
    with open(file, "w") as stream:
        stream.write(f"# vtk DataFile Version 3.0\nmany\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {count} double\n")
        for _ in range(count // 100):
            stream.write("1 2 3 " * 100 + "\n")
    process, ours = start("knotwork-read-vtk", file, limits=(60 << 20, SECONDS))
    assert process.wait(60) == 3
    os.close(ours)
    process, ours = start("knotwork-read-vtk", file, limits=(BYTES, 0))
    assert process.wait(60) in (-signal.SIGXCPU, -signal.SIGKILL)
    os.close(ours)
    os.remove(file)


def parts(descriptor):
    """What a reader hands over."""
    found = []
    with os.fdopen(descriptor, "rb") as stream:
        while True:
            length, = struct.unpack("<Q", stream.read(8))
            if length == 2**64 - 1:
                return found
            found.append(stream.read(length))


def test_hostile_xml_is_refused_with_its_place():
    """In time that grows with the text, and with memory that does not."""
    head = '<VTKFile type="UnstructuredGrid"><UnstructuredGrid>'
    cases = {
        "nested": (head + "<a>" * 1000000, "more than 100 elements lie in each other"),
        "entities": ('<?xml version="1.0"?>\n<!DOCTYPE a [<!ENTITY b "bbb">]>\n' + head, "line 2: document types"),
        "tag": (head + "<" + "a" * 3000000, "a tag has no end"),
        "open": (head, "<UnstructuredGrid> has no end"),
        "crossed": (head + "</VTKFile>", "</VTKFile> ends what has not begun"),
        "text": ("neither here\nnor there", "there is no <VTKFile>"),
        "other": ("<html></html>", "<html> stands outside"),
        "count": (head + '<Piece NumberOfPoints="-1"/>', "NumberOfPoints -1"),
        "huge": (head + '<Piece NumberOfPoints="1e9"/>', "NumberOfPoints 1e9"),
        "components": (head + '<DataArray type="Int8" Name="A" NumberOfComponents="99999999"/>', "'A' has NumberOfComponents"),
        "type": (head + '<DataArray type="Int7"/>', "unknown type 'Int7'"),
        "offset": (head + '<DataArray type="Int8" Name="A" format="appended" offset="77"/></UnstructuredGrid>'
                   '<AppendedData encoding="raw">_abc', "'A' begins outside of the appended data"),
        "attributes": (head + "<a " + "".join(f'b{i}="" ' for i in range(100)) + "/>", "is no tag"),
        "quote": (head + '<a b="1/>' + "\n" * 50, "a tag has no end"),
        "comment": (head + "<!-- <a>", "a comment has no end"),
    }
    for name, (text, words) in cases.items():
        file = path(name + ".vtu")
        with open(file, "w") as stream:
            stream.write(text)
        process, ours = start("knotwork-read-vtk", file)
        found = parts(ours)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = status
        assert found[0] != b"0" and words in found[1].decode() and name + ".vtu" in found[1].decode(), (name, found)
        assert usage.ru_maxrss < 100 << 10 and usage.ru_utime + usage.ru_stime < 5, (name, usage)


def grid(ids, ends="4", kind=9, more=""):
    """A .vtu of four points and one cell."""
    points = "0 0 0  1 0 0  1 1 0  0 1 0"
    return ('<VTKFile type="UnstructuredGrid" version="1.0" header_type="UInt64"><UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="1">'
            f'<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{points}</DataArray></Points><Cells>'
            f'<DataArray type="Int64" Name="connectivity" format="ascii">{ids}</DataArray>'
            f'<DataArray type="Int64" Name="offsets" format="ascii">{ends}</DataArray>'
            f'<DataArray type="UInt8" Name="types" format="ascii">{kind}</DataArray>{more}</Cells></Piece></UnstructuredGrid></VTKFile>')


def faces(stream):
    return ('<DataArray type="Int64" Name="faces" format="ascii">%s</DataArray><DataArray type="Int64" Name="faceoffsets" format="ascii">%d</DataArray>'
            % (stream, len(stream.split())))


def test_cells_have_points_that_are_there():
    tetrahedron = "4 3 0 1 2 3 0 1 3 3 1 2 3 3 0 2 %d"
    cases = {"sound": (grid("0 1 2 3"), None), "beyond": (grid("0 1 2 4294967295"), "point 4294967295 of 4"),
             "negative": (grid("0 1 2 -1"), "point -1 of 4"), "polyhedron": (grid("0 1 2 3", kind=42, more=faces(tetrahedron % 3)), None),
             "face": (grid("0 1 2 3", kind=42, more=faces(tetrahedron % 99)), "faces of cell 0"),
             "lines": (grid("0 1 2 3").replace("UnstructuredGrid", "PolyData").replace("NumberOfCells", "NumberOfLines").replace("Cells>", "Lines>")
                       .replace("0 1 2 3</", "0 1 2 7</"), "point 7 of 4")}
    for name, (text, words) in cases.items():
        file = path(name + (".vtp" if name == "lines" else ".vtu"))
        with open(file, "w") as stream:
            stream.write(text)
        process, ours = start("knotwork-read-vtk", file)
        found = parts(ours)
        assert process.wait() == 0
        assert (found[0] == b"0") == (words is None) and (words or "").encode() in found[1], (name, found)


def test_refusals_are_one_line_of_the_program():
    for name in ("negative_index.vtpc", "huge_index.vtpc", "offset_is_no_count.vtu", "huge_compression_header.vtp", "huge_field.vtk",
                 "crashes_opencascade.iges"):
        for job in (["info"], ["convert", "--output", path("out.vtu")], ["tessellate", "--output", path("out.vtp")]):
            done = knotwork_testing.run_program(*job[:1], knotwork_testing.data("Hostile/" + name), *job[1:])
            assert done.returncode == 1, (name, job, done.returncode)
            assert len(done.stderr.splitlines()) == 1 and name in done.stderr, done.stderr
            assert not re.search(r"0x[0-9a-f]{6}|vtk\w+ ?\(|ERROR", done.stderr), done.stderr


knotwork_testing.main(globals())
