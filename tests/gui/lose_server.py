# SPDX-License-Identifier: BSD-3-Clause
"""What remains when a rank of a server ends: the client learns which one and why, and saves its state and pictures; a
new client of a new server shows the same. Arguments: a folder, and the command that runs TestLostServer.py in a client
of a new server."""

import glob
import os
import shutil
import subprocess
import sys

FOLDER, COMMAND = os.path.abspath(sys.argv[1]), sys.argv[2:]
SECONDS = 90


def run(**variables):
    # As in ParaView's own tests: its dialog does not wait for an answer.
    environment = {**os.environ, "XDG_CONFIG_HOME": FOLDER, "DASHBOARD_TEST_FROM_CTEST": "1", **variables}
    done = subprocess.run(COMMAND, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=SECONDS)
    print(done.stdout, flush=True)
    return done


def find(pattern):
    found = glob.glob(os.path.join(FOLDER, "ParaView", pattern))
    assert len(found) == 1, f"{pattern}: {found}"
    return found[0]


shutil.rmtree(FOLDER, ignore_errors=True)
lost = run()
client = lost.stdout.partition("--- server ---")[0]
assert lost.returncode != 0, "ParaView ends the application"
assert "Rank 1 of the server (host " in client and "ended without a message" in client, "which rank, and why"
state = find("server-lost-*.pvsm")
assert state in client, "where the state is"
with open(find("ParaView*.ini"), encoding="utf-8") as settings:
    assert os.path.basename(state) in settings.read(), "it is among the recent files"
assert run(DSM_TEST_STATE=state).returncode == 0, "a new session shows the same"
