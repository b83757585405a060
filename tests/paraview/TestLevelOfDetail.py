# SPDX-License-Identifier: BSD-3-Clause
"""While the camera moves, the picture is traced at the resolution that ParaView's level of detail asks for,
and at the full one when the view is still; the samples of a still picture then begin anew."""

from dsm_testing import *

load_plugin()
view = create_view(480, 400)
view.UseFXAA = 0
source = simple.Wavelet()
display = show(source, view, [130.0], DSMSamplesPerPixel=2)
# Something that the surface comes through.
slab = show_surface(simple.Plane(Origin=[-10, -10, 0], Point1=[10, -10, 0], Point2=[-10, 10, 0]), view)
slab.DiffuseColor = slab.AmbientColor = [0.2, 1.0, 0.3]
place_camera(view)
still = render(view, "still")
TILES = 30 * 25  # of 16 x 16 pixels


def move(threshold, resolution):
    """An interactive render; the number of tiles that were traced for it."""
    view.LODThreshold = threshold
    view.LODResolution = resolution
    view.SMProxy.InteractiveRender()
    return sum(row["Tiles"] for row in get_rows(display))


check(move(1000.0, 0.0) == TILES, "below the threshold, every pixel is traced")
coarse = move(0.0, 0.0)
check(list(display.GetPropertyValue("DSMSamples")) == [1, 2], "while the camera moves, there is one sample")
check(4 * 4 <= coarse <= 8 * 7, f"at the coarsest level of detail, {coarse} tiles of {TILES}")
finer = move(0.0, 0.5)
check(coarse <= finer <= 15 * 13, f"at a middle one, {finer}")


# What such a picture looks like: the same, with coarser edges, and the plane in its place.
moving = grab(view, "moving")
covered, expected = get_covered(moving), get_covered(still)
wrong = (covered != expected).mean()
check(wrong < 0.03, f"a middle level of detail covers the same pixels but {100 * wrong:.2f} %")
green = [(picture[:, :, 1] > picture[:, :, 0] + 40) for picture in (moving, still)]
check(green[1].mean() > 0.02, "the plane shows")
wrong = (green[0] != green[1]).mean()
check(wrong < 0.03, f"and shows the plane in the same pixels but {100 * wrong:.2f} %")
check_equal(render(view), still, "a still picture is the full one again", 0)
display.SMProxy.UpdatePropertyInformation()
check(list(display.GetPropertyValue("DSMSamples")) == [2, 2], "with all samples")

# Pictures that are saved of interactive renders do not depend on how long anything took.
view.UseInteractiveRenderingForScreenshots = 1
view.LODResolution = 0.0
pictures = [render(view) for _ in range(2)]
check_equal(pictures[0], pictures[1], "two pictures of interactive renders are the same", 0)
