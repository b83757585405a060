# SPDX-License-Identifier: BSD-3-Clause
"""Time steps of DSM Volume Reader, in files of a series and in one file, are played to and fro: the pictures are
those of the same steps through ParaView's own reader, bit for bit. Called as run.py does, with the folder of
make_files.py behind the other arguments."""

import os
import sys

from dsm_testing import *

FILES = sys.argv[3]
TIMES = (0.0, 1.0, 3.0, 2.0, 0.0)
os.environ["XDG_CACHE_HOME"] = os.path.join(OUTPUT, "caches", str(get_ranks()))


def get_series(kind):
    return [os.path.join(FILES, f"play_{number:03}.{kind}") for number in range(4)]


load_plugin()
view = create_view()
view.UseFXAA = 0
scene = simple.GetAnimationScene()


def play(source, **properties):
    source.UpdatePipelineInformation()
    check(list(source.TimestepValues) == [0.0, 1.0, 2.0, 3.0], "four steps")
    scene.UpdateAnimationUsingDataTimeSteps()
    show(source, view, [0.7], "values", **properties)
    place_camera(view)
    pictures = []
    for time in TIMES:
        scene.AnimationTime = view.ViewTime = time
        pictures.append(render(view))
    simple.Delete(source)
    return pictures


expected = play(simple.XMLImageDataReader(FileName=get_series("vti")))
sizes = [get_covered(picture).sum() for picture in expected]
check(sizes[0] > sizes[1] > sizes[3] > sizes[2] > 0, f"the ball shrinks: {sizes}")
whole = os.path.join(FILES, "play.vtkhdf")
plays = [("a series", get_series("nhdr"), "Object based"), ("one file", whole, "Automatic")]
if get_ranks() == 1:
    plays += [("one file", whole, "Page based"), ("a series", get_series("nhdr"), "Replicated")]
for what, files, organization in plays:
    with Messages() as messages:
        pictures = play(simple.DSMVolumeReader(FileName=files), DSMMemoryOrganization=organization)
    check("ERROR" not in messages.text, f"{what}, {organization}: no error: {messages.text}")
    for time, picture, other in zip(TIMES, pictures, expected):
        check((picture == other).all(), f"{what}, {organization}: step {time}, bit for bit")

opened = simple.OpenDataFile(get_series("nhdr"))
check(len(opened.TimestepValues) == 4, "files that are chosen together are a series")
simple.Delete(opened)
steps = simple.DSMVolumeReader(FileName=os.path.join(FILES, "steps.vtkhdf"))
check(list(steps.TimestepValues) == [0.5, 1.0, 4.0], "a file tells its own times")
steps.PointArrays = ["g"]
steps.UpdatePipeline(1.0)
check(steps.PointData.keys() == ["g"], "the array that is chosen")
simple.Delete(steps)

# A file that is no step of the series is named, and the others go on.
odd = simple.DSMVolumeReader(FileName=[*get_series("nhdr")[:2], os.path.join(FILES, "detached.nhdr")])
with Messages() as messages:
    odd.UpdatePipeline(2.0)
if get_ranks() == 1:
    check("detached.nhdr" in messages.text and "no time step" in messages.text, "it is named")
with Messages() as messages:
    odd.UpdatePipeline(1.0)
check("ERROR" not in messages.text, f"the next step: {messages.text}")
