# SPDX-License-Identifier: BSD-3-Clause
"""A client that is far from its server: 20 megabits a second, 20 ms each way. Interactive pictures go
through ParaView's own compression and reduction, so they cost the link what a Contour's cost. Called as
TestSlowLink.py PLUGIN OUTPUT PORT."""

import subprocess
import time

import dsm_testing
from dsm_testing import *

link = subprocess.Popen(
    ["python3", os.path.join(os.path.dirname(dsm_testing.__file__), "slow_link.py"), sys.argv[3], "20", "20"],
    stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
simple.Connect("127.0.0.1", int(link.stdout.readline()))
load_plugin()


def count_bytes():
    link.stdin.write("\n")
    link.stdin.flush()
    return int(link.stdout.readline())


view = create_view(800, 600)
view.RemoteRenderThreshold = 0.0
view.LODThreshold = 0.0
source = simple.Wavelet()
contour = simple.Contour(Input=source, ContourBy=["POINTS", "RTData"], Isosurfaces=[130.0, 200.0])
traced = show(source, view, [130.0, 200.0])
triangles = show_surface(contour, view)
FRAMES = 4


def move(compressor):
    """KiB and seconds of an interactive frame."""
    view.CompressorConfig = compressor
    place_camera(view)
    view.SMProxy.InteractiveRender()
    before, start = count_bytes(), time.monotonic()
    for frame in range(FRAMES):
        place_camera(view, (0.6, 0.5 - 0.1 * frame, 1.0))
        view.SMProxy.InteractiveRender()
    seconds = (time.monotonic() - start) / FRAMES
    return (count_bytes() - before) / 1024 / FRAMES, seconds


simple.Hide(contour, view)
ours = {compressor: move(compressor) for compressor in ("vtkLZ4Compressor 0 3", "vtkSquirtCompressor 0 3", "NULL")}
simple.Hide(source, view)
simple.Show(contour, view)
theirs = {compressor: move(compressor) for compressor in ours}
for compressor, (kib, seconds) in ours.items():
    print(f"{compressor}: {kib:.0f} KiB and {1000 * seconds:.0f} ms a frame; "
          f"a Contour's {theirs[compressor][0]:.0f} KiB, {1000 * theirs[compressor][1]:.0f} ms", flush=True)
for compressor in ours:
    check(ours[compressor][0] < 1.3 * theirs[compressor][0] + 4, f"{compressor}: no more bytes than a Contour's")
check(ours["vtkLZ4Compressor 0 3"][0] < 0.5 * ours["NULL"][0], "compressed, they are far fewer")
check(ours["vtkSquirtCompressor 0 3"][1] < 2.0, "interactive frames arrive")
simple.Disconnect()
link.stdin.close()
link.wait(timeout=10)
