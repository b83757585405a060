# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts here share."""
import json
import os
import statistics
import subprocess
import time

HERE = os.path.dirname(os.path.abspath(__file__))
BENCH = os.path.join(HERE, "..", "..", "build", "bin", "dsm_bench")
SESSION = os.path.join(HERE, "session.txt")


def run_bench(bench, ranks, benchmark, **options):
    """The result of a benchmark under mpirun; an option `cache_fraction` is --cache-fraction."""
    command = ["mpirun", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"]
    if os.geteuid() == 0:
        command.append("--allow-run-as-root")
    command += ["-np", str(ranks), bench, benchmark, "--json", "-"]
    for name, value in options.items():
        command += ["--" + name.replace("_", "-"), str(value)]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)


def get_rows(display):
    """The statistics of each rank (vtkDSMStatistics::GetJson). In pvbatch."""
    display.SMProxy.UpdatePropertyInformation()
    return json.loads(str(display.GetProperty("DSMStatistics")).strip("'"))


def take_picture(view):
    """Seconds to the finished picture in memory. In pvbatch."""
    start = time.perf_counter()
    view.SMProxy.CaptureWindow(1)
    return time.perf_counter() - start


def time_isovalues(view, set_isovalue, isovalues):
    """Seconds from each of these isovalues to its picture: the median. In pvbatch."""
    seconds = []
    for isovalue in isovalues:
        start = time.perf_counter()
        set_isovalue(isovalue)
        take_picture(view)
        seconds.append(time.perf_counter() - start)
    return statistics.median(seconds)
