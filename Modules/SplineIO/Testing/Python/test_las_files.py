# SPDX-License-Identifier: BSD-3-Clause
"""LAS files: every version and point format as an independent reader finds them, and damaged ones as one line each."""
import random
import resource
import struct

import numpy as np

import knotwork
import knotwork_testing
import las_files


def path(name):
    return knotwork_testing.output("las/" + name)


def independent(file):
    """Points, channels and WKT of a LAS file, by the tables of the specification and numpy."""
    data = open(file, "rb").read()
    minor, head, begin, records, form, length = (struct.unpack_from(t, data, at)[0] for t, at in (
        ("<B", 25), ("<H", 94), ("<I", 96), ("<I", 100), ("<B", 104), ("<H", 105)))
    count = struct.unpack_from("<Q", data, 247)[0] if minor == 4 else struct.unpack_from("<I", data, 107)[0]
    scale, offset = (np.array(struct.unpack_from("<3d", data, at)) for at in (131, 155))
    base = ["xyz", "intensity", "returns", "flags"] + (["class", "user", "angle", "source", "time"] if form > 5 else ["angle", "user", "source"])
    kinds = {"xyz": ("<i4", (3,)), "intensity": "<u2", "returns": "u1", "flags": "u1", "class": "u1", "user": "u1", "source": "<u2",
             "angle": "<i2" if form > 5 else "i1", "time": "<f8", "color": ("<u2", (3,)), "infrared": "<u2", "wave": "V29"}
    more = {1: ["time"], 2: ["color"], 3: ["time", "color"], 4: ["time", "wave"], 5: ["time", "color", "wave"], 7: ["color"],
            8: ["color", "infrared"], 9: ["wave"], 10: ["color", "infrared", "wave"]}.get(form, [])
    fields = [(name, kinds[name]) if isinstance(kinds[name], str) else (name, *kinds[name]) for name in base + more]
    used = np.dtype(fields).itemsize
    points = np.frombuffer(data, fields + ([("extra", f"V{length - used}")] if length > used else []), count, begin)
    returns, flags = points["returns"].astype(int), points["flags"].astype(int)
    channels = {"Intensity": points["intensity"], "ReturnNumber": returns & (15 if form > 5 else 7),
                "NumberOfReturns": returns >> 4 if form > 5 else returns >> 3 & 7,
                "Classification": points["class"] if form > 5 else flags & 31, "Flags": flags & 15 if form > 5 else flags >> 5}
    for name, channel in (("time", "GpsTime"), ("color", "RGB"), ("infrared", "NearInfrared")):
        if name in points.dtype.names:
            channels[channel] = points[name]
    at, wkt = head, ""
    for _ in range(records):
        user, number, size = data[at + 2:at + 18].rstrip(b"\0"), *struct.unpack_from("<2H", data, at + 18)
        if (user, number) == (b"LASF_Projection", 2112):
            wkt = data[at + 54:at + 54 + size].rstrip(b"\0").decode()
        at += 54 + size
    return points["xyz"] * scale + offset, channels, wkt


def array(values):
    return np.array([values.GetTuple(i) for i in range(values.GetNumberOfTuples())]).squeeze()


def test_points_are_those_of_an_independent_reader():
    for form in range(11):
        for minor in range(0 if form < 2 else 2 if form < 4 else 3 if form < 6 else 4, 5):
            file = path(f"format_{form}_{minor}.las")
            las_files.write(file, form, minor, 200, seed=100 * form + minor, extra=form % 3)
            data = knotwork.read(file)
            points, channels, wkt = independent(file)
            assert np.array_equal(array(data.GetPoints().GetData()), points), (form, minor)
            assert data.GetPointData().GetNumberOfArrays() == len(channels), (form, minor)
            for name, values in channels.items():
                assert np.array_equal(array(data.GetPointData().GetArray(name)), values), (form, minor, name)
            assert data.GetFieldData().GetAbstractArray("CoordinateReferenceSystem").GetValue(0) == wkt != "", (form, minor)


def test_jobs_take_them():
    file = path("cloud.las")
    las_files.write(file, 2, 2, 3000)
    report = knotwork_testing.Files("las").report("fit", file, "--tolerance", 5, "--output", path("cloud.vtu"))
    assert report["points"] == 3000, report
    done = knotwork_testing.run_program("info", file)
    assert done.returncode == 0 and "3000 points" in done.stdout and "array RGB" in done.stdout, done


def test_compressed_files_are_refused_with_a_program_that_helps():
    las_files.write(path("cloud.las"), 2, 2, 10)
    data = bytearray(open(path("cloud.las"), "rb").read())
    data[104] |= 128
    for name in ("compressed.laz", "compressed.las", "compressed.copc.laz"):
        open(path(name), "wb").write(data)
        done = knotwork_testing.run_program("info", path(name))
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done
        assert name in done.stderr and "laszip" in done.stderr and "pdal" in done.stderr, done


def test_damaged_files_are_errors_without_memory():
    """Seeded: bytes of the header and of its records, truncations, and counts up to 64 bits."""
    for form, minor in ((3, 2), (7, 4)):
        las_files.write(path("sound.las"), form, minor, 50)
        sound = open(path("sound.las"), "rb").read()
        for seed in range(300):
            random.seed(seed)
            data = bytearray(sound)
            for _ in range(1 + seed % 3):
                data[random.randrange(480)] = random.randrange(256)
            if seed % 5 == 0:
                struct.pack_into("<Q", data, random.choice((96, 100, 107, 235, 243, 247)), random.getrandbits(64))
            if seed % 4 == 0:
                del data[random.randrange(len(data)):]
            open(path("damaged.las"), "wb").write(data)
            try:
                assert knotwork.read(path("damaged.las")).GetNumberOfPoints() * 20 <= len(data), (form, seed)
            except (knotwork.Error, knotwork.FileError) as failure:
                assert "damaged.las" in str(failure) and "\n" not in str(failure), (form, seed, failure)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < 1000000  # kilobytes; a count that is believed takes more


knotwork_testing.main(globals())
