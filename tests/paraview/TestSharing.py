# SPDX-License-Identifier: BSD-3-Clause
"""Two views of a dataset share its bricks, whatever else they show differently; the bricks leave with their last
user."""

from dsm_testing import *

load_plugin()
EXTENT = (0, 89, 0, 89, 0, 89)
SCRIPT = """image.SetExtent(piece)
add(image, points(piece)[0].astype('f4'), 'g')
add(image, distance(piece).astype('f4'))
"""
# Ranks may differ, without contradicting one another, where each has a part of its own.
volume = image_source(SCRIPT, EXTENT, in_parts=True)
mesh = simple.Sphere(ThetaResolution=300, PhiResolution=300, Radius=30.0)


class Picture:
    """What a view shows, and what the ranks hold for it and the others."""

    def __init__(self, view, display, turn=0.3):
        place_camera(view, (1.0, turn, 0.3))  # what a rank holds is told of frames that are traced
        with Messages() as messages:
            self.pixels = render(view)
        check(messages.text.strip() == "", "nothing is reported: " + messages.text)
        rows = get_rows(display)
        self.held = sum(row["BytesResident"] + row["BytesCopied"] for row in rows)
        self.publications = rows[0]["Publications"]


views = [create_view(), create_view()]
for view in views:
    view.UseFXAA = 0
for source, name in ((volume, "volume"), (mesh, "mesh")):
    is_volume = source is volume
    own = {"DSMIsoArray": ["POINTS", "f"], "DSMIsoValues": [0.7]} if is_volume else {}
    first = show_traced(source, views[0], **own, DSMMemoryOrganization="Replicated", DSMMemory=64)
    alone = Picture(views[0], first)
    check(get_covered(alone.pixels).any(), f"a {name} is drawn")
    second = show_traced(source, views[1], **own)
    both = Picture(views[1], second)
    check_equal(both.pixels, alone.pixels, f"{name}: a second view draws the same", tolerance=0)
    check(both.publications == alone.publications, "and nothing is built for it")
    check(both.held < 1.05 * alone.held, f"nor held: {both.held} bytes, {alone.held} before")

    # Other settings are those of one view.
    second.DiffuseColor = [1.0, 0.2, 0.2]
    second.DSMShadows = 1
    if is_volume:
        second.DSMIsoValues = [0.4]
    other = Picture(views[1], second)
    check((other.pixels != alone.pixels).any(), f"{name}: the second view can look different")
    check(other.publications == alone.publications, "with the same bricks")
    check_equal(Picture(views[0], first).pixels, alone.pixels, "and the first one stays", tolerance=0)

    if is_volume:
        # Another array, which the first view finds when it chooses it, too.
        second.DSMIsoArray = ["POINTS", "g"]
        second.DSMIsoValues = [30.0]
        slope = Picture(views[1], second)
        check(slope.publications == alone.publications + 1, "another array is built once")
        simple.ColorBy(first, ("POINTS", "g"))
        check(Picture(views[0], first).publications == slope.publications, "for both views")
        simple.ColorBy(first, None)
        render(views[0])
        second.DSMIsoArray = ["POINTS", "f"]
        second.DSMIsoValues = [0.7]
        third = Picture(views[1], second)
        check(third.held < 1.05 * alone.held, f"what nobody shows is gone: {third.held} bytes")

    # Hidden in one view, and shown in another way there.
    simple.Hide(source, views[0])
    render(views[0])
    published = Picture(views[1], second).publications
    check(published == third.publications if is_volume else published == alone.publications, "hidden in one view")
    simple.Show(source, views[0])
    check_equal(Picture(views[0], first).pixels, alone.pixels, "and shown again", tolerance=0)
    first.Representation = "Outline"
    render(views[0])
    check(Picture(views[1], second, 0.4).publications == published, "an outline in one, traced in the other")
    first.Representation = REPRESENTATION
    again = Picture(views[0], first)
    check_equal(again.pixels, alone.pixels, "the second view's bricks serve the first", tolerance=0)
    check(again.publications == published, "and nothing is built again")

    # New data are taken in once; there need not be room for them beside the old ones.
    if get_ranks() == 1:
        first.DSMMemory = second.DSMMemory = -(-3 * alone.held // (2 << 20))
        for view in views:
            render(view)
    if is_volume:
        source.Script = source.Script.replace("distance(piece)", "0.9 * distance(piece)")
    else:
        source.EndTheta = 340.0
    changed = Picture(views[0], first)
    check((changed.pixels != alone.pixels).any(), "other data are drawn")
    check(changed.held < 1.05 * alone.held, "and nothing is kept for the view that has not drawn them yet")
    if is_volume:
        second.DSMShadows = 0
        second.DiffuseColor = first.DiffuseColor
        check_equal(Picture(views[1], second).pixels, changed.pixels, "by both views", tolerance=0)
    check(Picture(views[1], second).publications == changed.publications, "from the same bricks")
    check(Picture(views[1], second, 0.5).held < 1.05 * alone.held, "and those of the old ones are gone")
    first.DSMMemory = second.DSMMemory = 64
    if is_volume:
        # Another dataset, of the same size and for all ranks but one the same.
        like = image_source("", EXTENT, in_parts=True)
        like.Script = source.Script.replace("0.9 * distance(piece)",
                                            "(0.9 if rank + 1 < ranks else 0.6) * distance(piece)")
        simple.Hide(source, views[1])
        unlike = Picture(views[1], show_traced(like, views[1], **own), 0.3)
        check(unlike.publications == changed.publications + 1, "what differs on one rank is built")
        check((unlike.pixels != changed.pixels).any(), "and drawn")
        simple.Delete(like)
    simple.Delete(source)
    for view in views:
        render(view)
