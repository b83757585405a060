# SPDX-License-Identifier: BSD-3-Clause
"""A volume of a pipeline that changes in some of its bricks from step to step: the pictures are those of the same
steps when each is shown alone, bit for bit, and what moves is in proportion to what changed."""

from dsm_testing import *

load_plugin()
EDGE = 97  # six bricks of 16 cells along each axis
EXTENT = (0, EDGE - 1) * 3
BRICKS = 6**3
SCRIPT = """
image.SetExtent(piece)
i, j, k = points(piece)
own = {region}
add(image, (distance(piece) + {base} + own * 0.004 * {step}).astype(np.float32))
"""
REGIONS = {"one brick": "(i > 36) * (i < 44) * (j > 36) * (j < 44) * (k > 84) * (k < 92)",
           "a layer": "(k > 81)", "all": "(k >= 0)"}
views = [create_view(), create_view()]
for view in views:
    view.UseFXAA = 0
view = views[0]


def get_script(what, step, base=0.001):
    return SCRIPT.format(region=REGIONS[what], step=step, base=base)


SCRIPTS = [get_script("all", 0), get_script("one brick", 2), get_script("one brick", 3), get_script("a layer", 4),
           get_script("a layer", 5), get_script("a layer", 5, 0.02), get_script("a layer", 5, 0.02)]
TILE_BRICKS = 8  # before a tile of the picture
# Bricks in which a step differs from the one before; the layer has the one brick.
CHANGED = [BRICKS, 1, 1, 36, 36, BRICKS, 0]


def get_moved(display):
    return sum(row["BytesPublished"] for row in get_rows(display))


def draw(source, **properties):
    display = show(source, view, [0.9], "f", **properties)
    place_camera(view)
    return display, render(view)


expected = []
for script in SCRIPTS:
    source = image_source(None, EXTENT, True)
    source.Script = source.Script.replace("None", script)
    display, picture = draw(source)
    expected.append(picture)
    simple.Delete(source)
    render(view)
check(all(get_covered(picture).mean() > 0.1 for picture in expected), "something is shown")
check((expected[1] != expected[0]).any() and (expected[2] != expected[1]).any(), "one brick is seen")
check((expected[5] == expected[6]).all(), "the same is the same")

settings = [("Object based", 1), ("Page based", 1), ("Replicated", 1), ("Automatic", 1)]
if get_ranks() > 1:
    settings += [("Object based", 0), ("Replicated", 0)]
for organization, sharing in settings:
    what = f"{organization}, {'sharing' if sharing else 'apart'}"
    source = image_source(None, EXTENT, True)
    template = source.Script
    source.Script = template.replace("None", SCRIPTS[0])
    display, picture = draw(source, DSMMemoryOrganization=organization, DSMHostSharing=sharing)
    check((picture == expected[0]).all(), f"{what}: the first step, bit for bit")
    before = get_moved(display)
    for number in range(1, len(SCRIPTS)):
        source.Script = template.replace("None", SCRIPTS[number])
        with Messages() as messages:
            picture = render(view)
        check("ERROR" not in messages.text, f"{what}: no error: {messages.text}")
        check((picture == expected[number]).all(), f"{what}: step {number}, bit for bit")
        rows = get_rows(display)
        moved, before = get_moved(display) - before, get_moved(display)
        share = moved / (BRICKS * 17**3 * 4)
        changed = CHANGED[number] / BRICKS
        print(f"{what}: step {number}: {100 * changed:.1f} % of the bricks changed, {100 * share:.1f} % moved")
        check(0.99 * changed <= share <= 1.25 * changed, f"{what}: only what changed moves")
        if organization == "Object based" and number in (1, 2, 6):
            received = sum(row["BytesReceived"] for row in rows)
            # A rank that took another's tiles needs the bricks before them, which it may never have had.
            new_bricks = TILE_BRICKS * sum(row["NewTiles"] for row in rows)
            check(received <= (2 * get_ranks() + new_bricks) * 17**3 * 5,
                  f"{what}: only what changed is fetched: {received}, and {new_bricks} bricks at most of new tiles")
    simple.Delete(source)
    render(view)

# Two views share the bricks. The first that is drawn brings them up to date for both, within a memory that has no room
# for the old ones beside the new ones.
source = image_source(None, EXTENT, True)
template = source.Script
source.Script = template.replace("None", SCRIPTS[0])
display, picture = draw(source, DSMMemoryOrganization="Object based", DSMMemory=7)
show(source, views[1], [0.9], "f")
place_camera(views[1])
check((render(views[1]) == expected[0]).all(), "two views: the first step, bit for bit")
before = get_moved(display)
for number in range(1, len(SCRIPTS)):
    source.Script = template.replace("None", SCRIPTS[number])
    with Messages() as messages:
        pictures = [render(each) for each in views]
    check("ERROR" not in messages.text, f"two views: no error: {messages.text}")
    check(all((picture == expected[number]).all() for picture in pictures), f"two views: step {number}, bit for bit")
    share, before = (get_moved(display) - before) / (BRICKS * 17**3 * 4), get_moved(display)
    changed = CHANGED[number] / BRICKS
    check(0.99 * changed <= share <= 1.25 * changed, f"two views: {share:.3f} moves of what is {changed:.3f}")
