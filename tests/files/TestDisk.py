# SPDX-License-Identifier: BSD-3-Clause
"""A volume that does not fit the memory: its bricks come from the file when rays meet them and leave memory
again, and the picture is that of the same data in memory, bit for bit. What happens to the file meanwhile is said,
and is over when the file is well again. Called as run.py does, with a folder for files behind the other arguments."""

import json
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
path = os.path.join(FOLDER, f"waves{get_ranks()}.raw")
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


def get_rows(display):
    display.SMProxy.UpdatePropertyInformation()
    return json.loads(str(display.GetProperty("DSMStatistics")).strip("'"))


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
in_memory = show(plain, view, [0.3], "values", DSMMemory=256)
expected = go_round(in_memory)
check(all(get_covered(picture).mean() > 0.05 for picture in expected), "something is shown")
simple.Delete(plain)
render(view)

display = show(source, view, [0.3], "values", DSMMemory=MEMORY)
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

# A file that is cut off while it is shown.
state = os.stat(path)
display.DSMMemoryOrganization = "Object based"
render(view)
os.truncate(path, state.st_size // 3)
os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))
with Messages() as messages:
    go_round(display)
    text = messages.text
check("Chunk (" in text and os.path.basename(path) in text, f"file and chunk are named: {text}")
# ... and is there again as it was.
values.tofile(path)
os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))
with Messages() as messages:
    again = go_round(display)
check("ERROR" not in messages.text, f"the next frame works: {messages.text}")
check(all((a == b).all() for a, b in zip(again, expected)), "and the pictures are right")
