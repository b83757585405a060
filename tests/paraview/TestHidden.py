# SPDX-License-Identifier: BSD-3-Clause
"""What is hidden keeps its bricks, until something else needs their memory: then what was shown the longest ago
goes first. What is shown in another way has none."""

from dsm_testing import *

load_plugin()
EXTENT = (0, 89, 0, 89, 0, 89)
SCRIPT = "image.SetExtent(piece)\nadd(image, distance(piece) + {amplitude} * np.sin(points(piece)[0]))\n"
view = create_view()
view.UseFXAA = 0
sources = [image_source(SCRIPT.format(amplitude=amplitude), EXTENT) for amplitude in (0.05, 0.1, 0.0)]
displays = []


def show_only(number):
    for source in sources:
        simple.Hide(source, view)
    simple.Show(sources[number], view)
    with Messages() as messages:
        picture = render(view)
    check(messages.text.strip() == "", "nothing is reported: " + messages.text)
    check(get_covered(picture).any(), f"dataset {number} is drawn")
    return picture, get_rows(displays[number])


for source in sources:
    displays.append(show(source, view, [0.7], "f", DSMMemoryOrganization="Replicated", DSMMemory=64))
    simple.Hide(source, view)
simple.Show(sources[0], view)
place_camera(view)
pictures = [show_only(number)[0] for number in range(3)]
held = show_only(0)[1]
for number in (1, 2, 0):
    picture, rows = show_only(number)
    check_equal(picture, pictures[number], f"dataset {number} is as it was", tolerance=0)
    check(rows[0]["Publications"] == held[0]["Publications"], "and nothing is built again")

# Room for two.
one = max(row["BytesResident"] + row["BytesCopied"] for row in held) / 3
limit = int(2.5 * one / 2**20)
for display in displays:
    display.DSMMemory = limit
for number in (1, 2, 0, 1):
    check_equal(show_only(number)[0], pictures[number], f"dataset {number} finds room", tolerance=0)
published = show_only(1)[1][0]["Publications"]
check(show_only(0)[1][0]["Publications"] == published, "what was shown last before is still there")
check(show_only(2)[1][0]["Publications"] > published, "but not what was shown the longest ago")

# Another representation.
for display in displays:
    display.DSMMemory = 64
for number in range(3):
    show_only(number)
for source, display in list(zip(sources, displays))[:2]:
    simple.Show(source, view)
    display.Representation = "Outline"
place_camera(view, (1.0, 0.2, 0.3))  # what a rank holds is told of frames that are traced
render(view)
left = max(row["BytesResident"] + row["BytesCopied"] for row in get_rows(displays[2]))
check(left < 1.1 * one, f"two that are shown as outlines have no bricks: {left} bytes are left of {3 * one:.0f}")

# Memory and threads belong to the session: the last word counts, whichever display it is said to.
for display in displays:
    display.Representation = REPRESENTATION
displays[1].DSMMemory = 0
displays[1].DSMMemoryOrganization = "Automatic"
displays[0].DSMThreads = 3
for source in sources:
    simple.Show(source, view)


def get_threads(turn):
    """Of a frame that is traced, from another direction."""
    place_camera(view, (1.0, turn, 0.3))
    render(view)
    return get_rows(displays[2])[0]["Threads"]


check(get_threads(0.3) == 3, "a display's setting is the session's")
displays[1].DSMThreads = 1
check(get_threads(0.4) == 1, "less counts, too")
simple.Hide(sources[0], view)
displays[0].DSMThreads = 2
check(get_threads(0.5) == 2, "also of a display that is hidden")
second = create_view()
second.UseFXAA = 0
other = show(sources[0], second, [0.7], "f")
check(other.DSMThreads == 2, "a display in another view begins with what holds")
other.DSMThreads = 3
render(second)
check(get_threads(0.6) == 3, "and is of the same session")

# Arrays of hidden blocks are not missing.
third = create_view()
blocks = [simple.Wavelet(), simple.HyperTreeGridRandom(OutputBounds=[12, 30, -9, 9, -9, 9]),
          simple.Cone(Center=[0, 20, 0], Height=10, Radius=6)]
names = ["image", "trees", "cone"]
group = simple.GroupDatasets(Input=blocks, BlockNames=names)
mixed = show(group, third, [150.0], "RTData")
simple.ColorBy(mixed, ("POINTS", "RTData"))
render(third)
place_camera(third)


def look_at(shown, kind=REPRESENTATION):
    mixed.Representation = kind
    mixed.BlockSelectors = [f"/Root/{name}" for name in names if name in shown]
    with Messages() as messages:
        picture = get_covered(render(third)).sum()
    return picture, messages.text


everything = look_at(names)[0]
for shown in (["trees", "cone"], ["cone"], names):
    for kind in ("DSM Volume", "DSM Slices", REPRESENTATION):
        covered, text = look_at(shown, kind)
        check(text.strip() == "", f"{kind} of {shown}: nothing is reported: {text}")
    check(0 < covered < everything or shown == names and covered == everything, f"{covered} pixels of {shown}")
mixed.DSMShow = "Surface"
check(look_at(["trees", "cone"])[1].strip() == "", "nor of colors of surfaces")
mixed.DSMShow, mixed.DSMIsoArray = "Isosurfaces", ["POINTS", "RTDta"]
check("'RTDta' does not exist" in look_at(["trees", "cone"])[1] or get_ranks() > 1, "a wrong name is reported")
