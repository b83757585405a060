# SPDX-License-Identifier: BSD-3-Clause
"""Run by a client of a server whose ranks each show a tile of one display: every tile has the part of the
picture that ParaView's Contour has there. Called as `TestTiles.py PLUGIN OUTPUT PORT SCREENS COLUMNS ROWS`."""

import struct

from dsm_testing import *

PORT, SCREENS, COLUMNS, ROWS = sys.argv[3], sys.argv[4], int(sys.argv[5]), int(sys.argv[6])
BACKGROUND = (0, 0, 51)


def read_screen(number):
    """What Xvfb has written: an xwd file of 4 bytes for each pixel, blue first."""
    with open(os.path.join(SCREENS, f"Xvfb_screen{number}"), "rb") as file:
        data = file.read()
    header = struct.unpack(">25I", data[:100])
    height, line, colors = header[5], header[12], header[19]
    pixels = numpy.frombuffer(data, numpy.uint8, height * line, header[0] + 12 * colors)
    return pixels.reshape(height, -1, 4)[:, : header[4], 2::-1].astype(int)


def read_tiles():
    simple.Render(view)
    simple.Render(view)
    return [read_screen(number) for number in range(COLUMNS * ROWS)]


def get_covered_tile(pixels):
    return (abs(pixels - numpy.array(BACKGROUND)) > 6).any(axis=2)


def compare(what):
    simple.Hide(contour, view)
    simple.Show(source, view)
    traced = read_tiles()
    simple.Hide(source, view)
    simple.Show(contour, view)
    for number, (mine, reference) in enumerate(zip(traced, read_tiles())):
        covered, expected = get_covered_tile(mine), get_covered_tile(reference)
        check(0.02 < expected.mean() < 0.9, f"{what}: tile {number} shows a part")
        wrong = (covered != expected).mean()
        check(wrong < 0.005, f"{what}: it is Contour's but for {100 * wrong:.2f} %")
        difference = abs(mine - reference).mean()
        check(difference < 2.0, f"{what}: colours differ by {difference:.2f} of 255")


simple.Connect("127.0.0.1", int(PORT))
load_plugin()
view = create_view()
layout = simple.CreateLayout("tiles")
simple.AssignViewToLayout(view=view, layout=layout)
layout.SMProxy.ShowViewsOnTileDisplay()
source = simple.Wavelet()
show(source, view, [157.0], "RTData")
contour = simple.Contour(source, ContourBy=["POINTS", "RTData"], Isosurfaces=[157.0], ComputeScalars=0)
show_surface(contour, view)
place_camera(view)
compare("all")
cone = simple.Cone(Radius=8.0, Height=20.0, Center=[0.0, 8.0, 0.0], Resolution=40)
show_surface(cone, view)
place_camera(view, (-0.7, 0.3, 0.4))
compare("beside a Surface")
simple.Disconnect()
