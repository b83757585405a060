# SPDX-License-Identifier: BSD-3-Clause
"""Time steps of DSM Volume Reader, in files of a series and in one file, are played to and fro: the pictures are
those of the same steps through ParaView's own reader, bit for bit. Called as run.py does, with the folder of
make_files.py behind the other arguments."""

import os
import shutil
import sys

from dsm_testing import *

FILES = sys.argv[3]
TILE_BRICKS = 8  # that rays of a tile meet, at most: it is narrower than a brick, so those around a corner
TIMES = (0.0, 1.0, 3.0, 2.0, 0.0)
os.environ["XDG_CACHE_HOME"] = os.path.join(OUTPUT, "caches", str(get_ranks()))


def get_series(kind, name="play", folder=FILES):
    return [os.path.join(folder, f"{name}_{number:03}.{kind}") for number in range(4)]


load_plugin()
view = create_view()
view.UseFXAA = 0
scene = simple.GetAnimationScene()


def play(source, **properties):
    source.UpdatePipelineInformation()
    check(list(source.TimestepValues) == [0.0, 1.0, 2.0, 3.0], "four steps")
    scene.UpdateAnimationUsingDataTimeSteps()
    show(source, view, [0.7], "play", **properties)
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

# Before 9.4, VTK adds up steps wrongly, and silently, where arrays are not of its own classes; since then, it rounds
# such sums in another way.
statistics = []
for source in (simple.DSMVolumeReader(FileName=get_series("nhdr")),
               simple.XMLImageDataReader(FileName=get_series("vti"))):
    of_source = simple.TemporalStatistics(Input=simple.Wavelet())
    of_source.Input = source
    of_source.UpdatePipeline()
    names = [f"play_{of}" for of in ("average", "minimum", "maximum", "stddev")]
    statistics.append([of_source.PointData[name].GetRange(0) for name in names])
    simple.Delete(of_source)
    if source.SMProxy.GetXMLName() == "DSMVolumeReader":
        check(source.ValuesInMemory == 0, "values stay in the file")
    simple.Delete(source)
rounding = 0.0 if simple.GetParaViewVersion() < (6, 0) else 1e-6
check(numpy.allclose(*statistics, rtol=rounding, atol=0), f"statistics of all steps: {statistics}")

# Of a step, only bricks that are not as they were are fetched: 81 points are 5 bricks of 16 cells along each axis, and
# what changes lies within the fourth of them.
folder = os.path.join(OUTPUT, "calm", str(get_ranks()))
os.makedirs(folder, exist_ok=True)
calm = get_series("h5", "calm", folder)
for source, target in zip(get_series("vti", "calm"), calm):
    reader = simple.XMLImageDataReader(FileName=[source])
    simple.SaveData(target, proxy=reader, PointDataArrays=["calm"])
    simple.Delete(reader)


def play_calm(source, times, **properties):
    display = show(source, view, [0.7], "calm", **properties)
    place_camera(view)
    pictures, fetched, allowed = [], [], []
    for time in times:
        view.ViewTime = time
        simple.Render(view)
        rows = get_rows(display) if properties else []
        pictures.append(render(view))
        # Each rank one, and those before the tiles that it took over from another.
        allowed.append(get_ranks() + TILE_BRICKS * sum(row["NewTiles"] for row in rows))
        fetched.append(sum(row["Misses"] - row["Joins"] + row["Prefetches"] for row in rows))
    simple.Delete(source)
    return pictures, fetched, allowed


TO_AND_FRO = (0.0, 1.0, 2.0, 3.0, 2.0, 0.0, 3.0)
expected, _, _ = play_calm(simple.XMLImageDataReader(FileName=get_series("vti", "calm")), TO_AND_FRO)
check((expected[0] != expected[1]).any() and (expected[1] != expected[3]).any(), "steps differ")
check((expected[1] == expected[2]).all(), "the third is as the second")
for organization in ("Object based", "Page based", "Replicated"):
    for what, series in (("bricks", calm), ("values", get_series("nhdr", "calm"))):
        source = simple.DSMVolumeReader(FileName=series)
        with Messages() as messages:
            pictures, fetched, allowed = play_calm(source, TO_AND_FRO, DSMMemoryOrganization=organization)
        check("ERROR" not in messages.text, f"{what}, {organization}: no error: {messages.text}")
        for time, picture, other in zip(TO_AND_FRO, pictures, expected):
            check((picture == other).all(), f"{what}, {organization}: calm step {time}, bit for bit")
        told = f"{fetched} fetched of {allowed}"
        check(fetched[2] <= allowed[2] - get_ranks(), f"nothing for what is equal: {told}")
        check(all(count > 0 for count in fetched[1:2] + fetched[3:]), f"what changed: {told}")
        check(all(count <= most for count, most in zip(fetched[1:], allowed[1:])), f"one brick, no more: {told}")

# With colors of another array, in two views, in the least memory that there may be.
tinted = os.path.join(FILES, "tinted.vtkhdf")
colors = simple.GetColorTransferFunction("tint")
colors.RescaleTransferFunction(-1.0, 2.0)
other_view = create_view()
view.UseFXAA = other_view.UseFXAA = 0  # a new view has others forget theirs


def play_tinted(source, **properties):
    pictures = []
    displays = [show(source, each, [value], "tinted", **properties)
                for each, value in ((view, 0.7), (other_view, 0.65))]
    displays[0].ColorArrayName = ["POINTS", "tint"]
    displays[0].LookupTable = colors
    place_camera(view)
    place_camera(other_view, (1.0, 0.7, 0.4))
    for time in TIMES:
        for each in (view, other_view):
            each.ViewTime = time
        pictures += [render(view), render(other_view)]
    simple.Delete(source)
    return pictures


expected_pair = play_tinted(simple.XMLImageDataReader(FileName=get_series("vti", "tinted")))
check((expected_pair[0] != expected_pair[2]).any() and (expected_pair[1] != expected_pair[3]).any(),
      "both views change")
for memory in (0, 3):
    with Messages() as messages:
        pictures = play_tinted(simple.DSMVolumeReader(FileName=[tinted]), DSMMemory=memory)
    check("ERROR" not in messages.text, f"colours, two views, {memory} MiB: no error: {messages.text}")
    for number, (picture, other) in enumerate(zip(pictures, expected_pair)):
        check((picture == other).all(), f"colours, two views, {memory} MiB: picture {number}, bit for bit")
simple.Delete(other_view)
view.UseFXAA = 0

# A file that is replaced when a series has it no longer open: what was read of it must not meet the new values.
many = [os.path.join(folder, f"many_{number}.h5") for number in range(9)]
for number, file in enumerate(many):
    shutil.copyfile(calm[number % 4], file)
source = simple.DSMVolumeReader(FileName=many)
scene.UpdateAnimationUsingDataTimeSteps()
display = show(source, view, [0.7], "calm")
place_camera(view)


def go_to(time):
    with Messages() as messages:
        scene.AnimationTime = view.ViewTime = time
        picture = render(view)
    return picture, messages.text


for number in range(9):
    last, text = go_to(float(number))
    check("ERROR" not in text and (last == expected[number % 4]).all(), f"step {number} of many: {text}")
shutil.copyfile(calm[3], many[0] + ".new")
os.replace(many[0] + ".new", many[0])
picture, text = go_to(0.0)
check("many_0.h5" in text and "Reload it." in text, f"a step that was replaced is named: {text}")
check((picture == last).all(), "the last picture stays")
picture, text = go_to(1.0)
check("ERROR" not in text and (picture == expected[1]).all(), f"the other steps go on: {text}")
with Messages() as messages:
    simple.ReloadFiles(source)
picture, text = go_to(0.0)
check("ERROR" not in text and (picture == expected[3]).all(), f"it is there when it is reloaded: {text}")
simple.Delete(source)

# A header that stays as it is, beside values that are written anew.
apart = []
for number, path in enumerate(get_series("nhdr")):
    text = open(path).read()
    values = next(line.split(":")[1].strip() for line in text.splitlines() if line.startswith("data file"))
    apart.append(os.path.join(folder, f"apart_{number}.nhdr"))
    with open(apart[-1], "w") as header:
        header.write(text.replace(values, f"apart_{number}.values"))
    shutil.copyfile(os.path.join(FILES, values), os.path.join(folder, f"apart_{number}.values"))
source = simple.DSMVolumeReader(FileName=apart)
scene.UpdateAnimationUsingDataTimeSteps()
display = show(source, view, [0.7], "apart")
pictures = [go_to(float(number))[0] for number in (3, 1)]
check((pictures[0] != pictures[1]).any(), "two steps differ")
shutil.copyfile(os.path.join(folder, "apart_3.values"), os.path.join(folder, "apart_1.values"))
simple.ReloadFiles(source)
picture, text = go_to(1.0)
check("ERROR" not in text and (picture == pictures[0]).all(), f"values that were written anew are shown: {text}")
simple.Delete(source)

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
    check("detached.nhdr" in messages.text and "cannot be a time step" in messages.text, "it is named")
with Messages() as messages:
    odd.UpdatePipeline(1.0)
check("ERROR" not in messages.text, f"the next step: {messages.text}")
