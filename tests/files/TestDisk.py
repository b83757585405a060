# SPDX-License-Identifier: BSD-3-Clause
"""A volume that does not fit the memory: its bricks come from the file when rays meet them and leave memory
again, and the picture is that of the same data in memory, bit for bit. What happens to the file meanwhile is said,
and is over when the file is well again. Called as run.py does, with a folder for files behind the other arguments."""

import itertools
import os
import sys

from dsm_testing import *

FOLDER = sys.argv[3]
os.environ["XDG_CACHE_HOME"] = os.path.join(OUTPUT, "caches", str(get_ranks()))
os.makedirs(FOLDER, exist_ok=True)
EDGE = 96  # 3.4 MiB of floats, 4.2 MiB of bricks
MEMORY = 2  # MiB of each rank, of which an eighth is for chunks

load_plugin()
view = create_view()
view.UseFXAA = 0
ARRAY = f"waves{get_ranks()}"
path = os.path.join(FOLDER, ARRAY + ".raw")
z, y, x = numpy.mgrid[0 : 1 : EDGE * 1j, 0 : 1 : EDGE * 1j, 0 : 1 : EDGE * 1j]
values = (numpy.sin(9 * x) * numpy.cos(7 * y) + numpy.sin(8 * z + 3 * x)).astype(numpy.float32)
values.tofile(path)

COPY = """
from vtkmodules.vtkCommonDataModel import vtkImageData
data = self.GetInputDataObject(0, 0)
output = self.GetOutputDataObject(0)
output.CopyStructure(data)
array = data.GetPointData().GetArray(0)
copy = array.NewInstance()
copy.DeepCopy(array)
output.GetPointData().AddArray(copy)
output.GetPointData().SetActiveScalars(array.GetName())
"""
EXTENT = """
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
self.GetOutputInformation(0).CopyEntry(self.GetInputInformation(0, 0), Pipeline.WHOLE_EXTENT())
"""
PLACES = ((0.6, 0.5, 1.0), (-1.0, 0.2, 0.3))


def open_file():
    return simple.DSMVolumeReader(
        FileName=path, RawDimensions=[EDGE] * 3, RawScalarType="float", RawSpacing=[1.0 / EDGE] * 3
    )


def go_round(display, isovalues=(0.3, 1.2)):
    pictures = []
    for place in PLACES:
        for value in isovalues:
            display.DSMIsoValues = [value]
            place_camera(view, place)
            pictures.append(render(view))
    return pictures


source = open_file()
plain = simple.ProgrammableFilter(Input=source)
plain.Script, plain.RequestInformationScript, plain.CopyArrays = COPY, EXTENT, 0
in_memory = show(plain, view, [0.3], ARRAY, DSMMemory=256)
expected = go_round(in_memory)
check(all(get_covered(picture).mean() > 0.05 for picture in expected), "something is shown")
simple.Delete(plain)
render(view)

display = show(source, view, [0.3], ARRAY)
render(view)
with Messages() as messages:
    display.DSMMemory = MEMORY
    render(view)
check("ERROR" not in messages.text, f"a limit that comes later is kept, too: {messages.text}")
for organization in ("Automatic", "Object based", "Page based", "Replicated"):
    display.DSMMemoryOrganization = organization
    with Messages() as messages:
        pictures = go_round(display)
    check("ERROR" not in messages.text, f"{organization}: no error: {messages.text}")
    for number, (picture, other) in enumerate(zip(pictures, expected)):
        check((picture == other).all(), f"{organization}: picture {number} as from memory, bit for bit")
    rows = get_rows(display)
    check(all(row["BytesResident"] == 0 for row in rows), f"{organization}: nothing stays for good")
    for row in rows:
        held = row["BytesOfTables"] + row["CacheCapacity"]
        check(held <= row["MemoryBudget"] == MEMORY << 20, f"{organization}: within the memory")
        check(row["BytesCached"] <= row["CacheCapacity"] < 6 << 18, f"{organization}: the cache is small")
    check(any(row["BytesCached"] > 0 for row in rows), f"{organization}: bricks came from the file")


def expect_failure(what, last, *words):
    """Of the first picture that needs what is not in memory: it is said, and the last picture stays."""
    for place, value in itertools.product(PLACES, (0.3, 1.2)):
        with Messages() as messages:
            display.DSMIsoValues = [value]
            place_camera(view, place)
            picture = render(view)
        if messages.text:
            check(all(word in messages.text for word in words), f"{what}: file and cause are named: {messages.text}")
            check((picture == last).all(), f"{what}: the last picture stays")
            view.GetActiveCamera().Dolly(0.2)
            with Messages():
                check((render(view) == last).all(), f"{what}: all of it, wherever the camera goes")
            return
        last = picture
    check(False, f"{what} is noticed")


def expect_pictures(what, pictures):
    with Messages() as messages:
        again = go_round(display)
    check("ERROR" not in messages.text, f"{what}: nothing is said: {messages.text}")
    check(all((a == b).all() for a, b in zip(again, pictures)), f"{what}: the pictures are right")


name = os.path.basename(path)
state = os.stat(path)
display.DSMMemoryOrganization = "Object based"


def stay_unchanged():
    os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))


# A file that is cut off while it is shown, and then is there again as it was.
last = render(view)
os.truncate(path, state.st_size // 3)
stay_unchanged()
expect_failure("a file that is cut off", last, "Chunk (", name)
values.tofile(path)
stay_unchanged()
expect_pictures("a file that is whole again", expected)

# One that goes away, and one of that name that another program puts in its place: what was opened is still there.
os.rename(path, path + ".away")
expect_pictures("a file that goes away", expected)
(2.0 - values).astype(numpy.float32).tofile(path)
expect_pictures("a file that another takes the place of", expected)
os.replace(path + ".away", path)

# One that is written to: not a mixture of old and new, but an error until it is reloaded.
last = render(view)
(0.9 * values).astype(numpy.float32).tofile(path)
expect_failure("a file that is written to", last, name, "changed after it was opened. Reload it.")
simple.ReloadFiles(source)
with Messages() as messages:
    pictures = go_round(display)
check("ERROR" not in messages.text, f"a file that is reloaded: nothing is said: {messages.text}")
check(all((a != b).any() for a, b in zip(pictures, expected)), "a file that is reloaded: it shows the new values")

# A brick file whose chunks are not what was written: their checksums tell.
path = os.path.join(FOLDER, f"waves{get_ranks()}.h5")
simple.SaveData(path, proxy=source)
simple.Delete(source)
name = os.path.basename(path)
with open(path, "rb") as file:
    written = file.read()
source = simple.DSMVolumeReader(FileName=path)
display = show(source, view, [0.3], ARRAY, DSMMemory=MEMORY)
expected = go_round(display)
last = expected[-1]
state = os.stat(path)
middle = slice(len(written) // 4, -len(written) // 4)
spoilt = numpy.frombuffer(written, numpy.uint8).copy()
spoilt[middle] = numpy.random.default_rng(1).integers(0, 256, spoilt[middle].size)
spoilt.tofile(path)
stay_unchanged()
expect_failure("a file with other bytes", last, "Chunk (", name, "checksum")
with open(path, "wb") as file:
    file.write(written)
stay_unchanged()
expect_pictures("a file with its own bytes again", expected)
