# SPDX-License-Identifier: BSD-3-Clause
"""The main job on a cluster (see run_cluster.py): every memory organisation draws bit for bit what one
rank draws. Prints frames/s as ratios to replication, which needs no messages for bricks. The frames
are those of a session, whose counts begin with empty caches: in a second round every brick that a rank
needs may be there already.

    TestIsosurface.py DSM_BENCH RANKS"""

import json
import os
import subprocess
import sys
import tempfile

BENCH, RANKS = sys.argv[1], sys.argv[2]
FOLDER = os.path.dirname(os.path.abspath(__file__))
JOB = ["isosurface", "--volume", "sphere:160:float", "--isovalue", "0.5", "--size", "320x240",
       "--session", os.path.join(FOLDER, "..", "benchmarks", "session.txt"), "--threads", "1",
       "--cache-fraction", "0.16"]


def run(store, cluster):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "result.json")
        job = [BENCH, *JOB, "--store", store, "--json", path]
        if cluster:
            job = [sys.executable, os.path.join(FOLDER, "run_cluster.py"), "--ranks", RANKS, *job]
        code = subprocess.run(job, check=False, timeout=120).returncode
        if code != 0:
            sys.exit(code)  # 77: skipped
        with open(path, encoding="ascii") as file:
            return json.load(file)


alone = run("replicated", cluster=False)
replicated = None
for organization in ("replicated", "object", "paged"):
    result = run(organization, cluster=True)
    replicated = replicated or result
    ratio = result["frames_per_second"] / replicated["frames_per_second"]
    print(f"{organization}: {result['frames_per_second']:.2f} frames/s, {ratio:.2f} of replicated; "
          f"{result['misses']} misses, {result['bytes_received'] / 2**20:.1f} MiB received", flush=True)
    assert result["rank_count"] == int(RANKS), "all ranks took part"
    assert result["image_hash"] == alone["image_hash"], f"{organization}: the picture is another"
    if organization != "replicated":
        assert result["bytes_received"] > 0, f"{organization}: bricks came over the network"
