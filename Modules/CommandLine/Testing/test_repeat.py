# SPDX-License-Identifier: BSD-3-Clause
"""Every job twice, once with one thread: outputs are the same to the last bit, so nothing measured is in them."""
import os
import tempfile

import job_inputs
import knotwork_testing


def outputs(arguments, threads):
    with tempfile.TemporaryDirectory() as folder:
        done = knotwork_testing.run_program(*arguments, "--threads", threads, folder=folder)
        assert done.returncode in (0, 3), (arguments, done.stderr)
        return {os.path.relpath(os.path.join(place, name), folder): open(os.path.join(place, name), "rb").read()
                for place, _, names in os.walk(folder) for name in names if name != "report.json"}


def test_outputs_are_the_same_from_run_to_run():
    job_inputs.make_files()
    compared = 0
    for arguments, kind in job_inputs.runs():
        ending = job_inputs.ENDINGS[kind][0]
        job = job_inputs.on(arguments, job_inputs.sound(kind, ending))
        if job[0] in ("fit", "flatten", "map", "trim", "parameterize") and "--table" not in job:
            job += ["--table", "numbers.csv"]
        first, second = outputs(job, 0), outputs(job, 1)
        assert first.keys() == second.keys() and (first or job[0] == "info"), (job, first.keys())
        for name in first:
            assert first[name] == second[name], (job, name)
            compared += 1
    assert compared > 40, compared


knotwork_testing.main(globals())
