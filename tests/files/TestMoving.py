# SPDX-License-Identifier: BSD-3-Clause
"""While the camera moves over a volume whose bricks are not in memory, a coarser level of its file stands in, where
the user wants that; every other picture is of the finest, bit for bit. Called as run.py does, with dsm_convert, a
folder for files and a Python behind the other arguments."""

import subprocess

from dsm_testing import *

CONVERT, FOLDER = sys.argv[3:5]
os.environ["XDG_CACHE_HOME"] = os.path.join(OUTPUT, "caches", str(get_ranks()))
os.makedirs(FOLDER, exist_ok=True)
EDGE = 160  # 16 MiB of floats, 20 of bricks
MEMORY = 3  # MiB of each rank
PLACES = ((0.6, 0.5, 1.0), (-1.0, 0.2, 0.3), (0.2, -0.9, -0.6))

load_plugin()
rank = vtkMultiProcessController.GetGlobalController().GetLocalProcessId()
ARRAY = f"waves{get_ranks()}"
path = os.path.join(FOLDER, ARRAY)
# A surface that is nearly everywhere.
z, y, x = numpy.ogrid[0 : 1 : EDGE * 1j, 0 : 1 : EDGE * 1j, 0 : 1 : EDGE * 1j]
values = numpy.sin(21 * x) * numpy.cos(19 * y) + numpy.sin(20 * z + 3 * x)
values.astype(numpy.float32).tofile(path + ".raw")
environment = {name: value for name, value in os.environ.items() if not name.startswith(("OMPI", "PMIX"))}
# Compressed: what is not comes too soon.
subprocess.run([CONVERT, "--quiet", "--compression", "deflate", "--levels", "all", "--raw-size",
                f"{EDGE},{EDGE},{EDGE}",
                "--raw-type", "float32", "--spacing", f"{1 / EDGE},{1 / EDGE},{1 / EDGE}", path + ".raw",
                path + ".vtkhdf"], check=True, timeout=100, env=environment)
os.remove(path + ".raw")

view = create_view()
view.UseFXAA = 0
view.ImageReductionFactor = 1
source = simple.DSMVolumeReader(FileName=path + ".vtkhdf")


def get_coarser():
    """How many levels below the finest the last picture is."""
    rows = get_rows(display)
    levels = {row["CoarserLevel"] for row in rows}
    check(len(levels) == 1, "the ranks agree")
    return levels.pop()


def move(place):
    place_camera(view, place)
    there = list(view.CameraPosition)
    # From elsewhere: what a still picture has shown is not traced again.
    for position in ([-value for value in there], there):
        view.CameraPosition = position
        view.SMProxy.InteractiveRender()
    return get_coarser()


display = show(source, view, [0.8], ARRAY, DSMMemory=MEMORY, DSMThreads=1)
expected = [None] * len(PLACES)
for number, place in enumerate(PLACES):
    place_camera(view, place)
    expected[number] = render(view)
check(all(get_covered(picture).mean() > 0.2 for picture in expected), "something is shown")
levels = [move(place) for place in PLACES]
check(levels == [0] * len(PLACES), f"while the option is off, moving pictures are of the finest: {levels}")
check_equal(grab(view), expected[-1], "pixel for pixel")

display.DSMCoarserDataWhileMoving = 1
seen = []
with Messages() as messages:
    for number, place in enumerate(PLACES):
        seen.append(move(place))
        shown = grab(view)
        if seen[-1] == 0:
            check_equal(shown, expected[number], "a moving picture of the finest is the still one")
        else:
            check(abs(shown - expected[number]).max() > 8, f"one {seen[-1]} levels coarser is not")
            covered = get_covered(shown) != get_covered(expected[number])
            difference = abs(shown - expected[number]).mean()
            check(seen[-1] > 2 or (covered.mean() < 0.1 and difference < 25),
                  f"but shows much the same: {100 * covered.mean():.1f} % of the pixels, {difference:.1f} of 255")
        picture = render(view)
        check(get_coarser() == 0 and (picture == expected[number]).all(), "the still picture is of the finest")
check(max(seen) > 0, f"coarser levels stood in: {seen}")
check("ERROR" not in messages.text, f"nothing is reported: {messages.text}")

# Pictures that are kept, also of interactive renders.
name = os.path.join(OUTPUT, f"kept.{get_ranks()}.png")
for interactive in (0, 1):
    view.UseInteractiveRenderingForScreenshots = interactive
    for number, place in enumerate(PLACES[:2]):
        place_camera(view, place)
        simple.SaveScreenshot(name, view, ImageResolution=[300, 240])
        check(get_coarser() == 0, f"a screenshot (interactive: {interactive}) is of the finest")
view.UseInteractiveRenderingForScreenshots = 0

# What fits the memory is soon shown as it is: each try brings bricks.
display.DSMMemory = 512
levels = [move((0.6 + 0.02 * step, 0.5, 1.0)) for step in range(30)]
check(levels[-1] == 0, f"bricks that have come take the place of coarser ones: {levels}")
rows = get_rows(display)
check(all(row["BytesOfTables"] + row["CacheCapacity"] <= row["MemoryBudget"] for row in rows), "within the memory")

# Colored by itself, clipped, twice in the view: the same holds.
display.DSMMemory = MEMORY
simple.ColorBy(display, ("POINTS", ARRAY))
display.DSMIsoValues = [0.8, -0.4]
display.DSMClip = 1
for number, place in enumerate(PLACES):
    level = move(place)
    moving = grab(view)
    display.DSMCoarserDataWhileMoving = 0
    plain = render(view)
    display.DSMCoarserDataWhileMoving = 1
    check(level > 0 or abs(moving - plain).max() <= 1, f"coloured and clipped: level {level}")
    check((render(view) == plain).all(), "coloured and clipped, the still picture is of the finest")
    if level > 0:
        wrong = (get_covered(moving) != get_covered(plain)).mean()
        check(wrong < 0.1, f"and clipped alike while moving: {100 * wrong:.1f} %")

# Slices read the bricks that they pass through.
simple.Delete(source)
source = simple.DSMVolumeReader(FileName=path + ".vtkhdf")
display = simple.Show(source, view)
simple.ColorBy(display, ("POINTS", ARRAY))
display.DSMMemory, display.DSMThreads = 64, 1
display.DSMSliceX = display.DSMSliceY = 0
display.DSMSliceZIndex = 75
display.Representation = "DSM Slices"
view.CameraParallelProjection = 1
before = 0
BRICK_BYTES = 4 * 17**3  # and a little for ranges; bricks have 16 cells along each axis
for number, place in enumerate(((0.0, 0.0, 1.0), (0.3, 0.5, 1.0))):
    place_camera(view, place)
    if number == 1:
        display.DSMSliceZ, display.DSMSlicePlane = 0, 1
        display.DSMSliceOrigin, display.DSMSliceNormal = [0.5] * 3, [0.2, -0.3, 1.0]
    picture = render(view)
    check(get_covered(picture).mean() > 0.15, "the slice is shown")
    cached = sum(row["BytesCached"] for row in get_rows(display))
    fetched, before = (cached - before) // BRICK_BYTES, cached
    corners = numpy.arange(-(-(EDGE - 1) // 16)) * 16 / EDGE
    heights = [0.2 * (corners[None, None, :] - 0.5 + c % 2 * 16 / EDGE)
               - 0.3 * (corners[None, :, None] - 0.5 + c // 2 % 2 * 16 / EDGE)
               + (corners[:, None, None] - 0.5 + c // 4 * 16 / EDGE) for c in range(8)]
    crossed = len(corners) ** 2 if number == 0 else ((numpy.min(heights, 0) <= 0) & (numpy.max(heights, 0) >= 0)).sum()
    check(0.5 * crossed < fetched <= 2 * crossed, f"{fetched} bricks are fetched of a slice through {crossed}")
view.CameraParallelProjection = 0

# Where the samples are closer than pixels, so that the finest level shows nothing more, a coarser one is shown. It is
# the picture of that level by itself.
simple.Delete(source)
source = simple.DSMVolumeReader(FileName=path + ".vtkhdf")
display = show(source, view, [0.8], ARRAY, DSMMemory=64, DSMThreads=1)
place_camera(view, PLACES[0])
near = numpy.array(view.CameraPosition)
middle = numpy.array(view.CameraFocalPoint)
seen_levels = set()
CASES = (("DSM Ray Traced", 4, 1), ("DSM Ray Traced", 1, 4), ("DSM Ray Traced", 16, 0.125), ("DSM Volume", 8, 1))
for kind, away, pixels in CASES:
    display.Representation = kind
    view.CameraPosition = list(middle + away * (near - middle))
    toward = (middle - view.CameraPosition) / numpy.linalg.norm(middle - view.CameraPosition)
    corners = numpy.array([[c & 1, c >> 1 & 1, c >> 2] for c in range(8)])
    depth = ((corners - view.CameraPosition) @ toward).min()
    scale = view.ViewSize[1] / (2 * numpy.tan(numpy.radians(view.CameraViewAngle / 2)) * depth)
    display.DSMLevelOfDetail, display.DSMPixelsPerSample = "Automatic", pixels
    automatic = render(view)
    level = get_coarser()
    width = 2**level * scale / EDGE  # of the shown level's samples, in pixels
    check((width <= pixels or level == 0) and 2 * width > 0.5 * pixels,
          f"{kind}, {away} times as far: at level {level}, samples are {width:.2f} of {pixels} pixels wide")
    seen_levels.add(level)
    display.DSMLevelOfDetail = "Finest"
    finest = render(view)
    check(get_coarser() == 0, "the finest on request")
    check((automatic == finest).all() == (level == 0), "the levels differ")
    difference = abs(automatic - finest).mean()
    check(difference < 2 * pixels, f"but by {difference:.2f} of 255 on the mean")
    if kind == "DSM Ray Traced" and level > 0:
        other = simple.DSMVolumeReader(FileName=path + ".vtkhdf", LevelofDetail=level)
        display.Visibility = 0
        own = show(other, view, [0.8], ARRAY)
        view.CameraPosition = list(middle + away * (near - middle))
        check_equal(render(view), automatic, f"level {level} by hand is the same picture")
        simple.Delete(other)
        display.Visibility = 1
check(len(seen_levels) > 2, f"levels: {seen_levels}")

# A coarser level that was opened has its own below it; where there is none, the option does nothing.
simple.Delete(source)
source = simple.DSMVolumeReader(FileName=path + ".vtkhdf", LevelofDetail=4)
display = show(source, view, [0.8], ARRAY, DSMMemory=MEMORY, DSMCoarserDataWhileMoving=1)
check([move(place) for place in PLACES] == [0] * len(PLACES), "the coarsest has nothing below it")
simple.Delete(source)
os.remove(path + ".vtkhdf")
