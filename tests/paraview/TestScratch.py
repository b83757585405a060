# SPDX-License-Identifier: BSD-3-Clause
"""What does not fit the memory goes to a scratch directory, where the user has given one: the same pictures, within
the memory. What is wrong with the directory is said, and over when the directory is well again."""

import shutil

from dsm_testing import *

load_plugin()
EXTENT = (0, 89, 0, 89, 0, 89)  # doubles: more than 1 MiB on each of 4 ranks
SCRIPT = "image.SetExtent(piece)\nadd(image, distance(piece) + 0.05 * np.sin(points(piece)[0]))\n"
DISK = os.path.join(OUTPUT, f"disk{get_ranks()}")
PLACES = ((0.6, 0.5, 1.0), (-1.0, 0.2, 0.3))
shutil.rmtree(DISK, ignore_errors=True)
os.makedirs(DISK)
view = create_view()
view.UseFXAA = 0


def go_round():
    pictures = []
    for place in PLACES:
        place_camera(view, place)
        pictures.append(render(view))
    return pictures


def check_scratch(display, expected, memory, what, is_told=False):
    with Messages() as messages:
        pictures = go_round()
    check("ERROR" not in messages.text, f"{what}: no error: {messages.text}")
    if is_told and get_ranks() > 1:
        check(messages.text.count("are in scratch files") == 1, f"{what}: that scratch files are used is said, once")
    check(all((a == b).all() for a, b in zip(pictures, expected)), f"{what}: the same pictures, bit for bit")
    for row in get_rows(display):
        check("scratch files" in row["Explanation"], f"{what}: {row['Explanation']}")
        check(row["BytesResident"] == 0, f"{what}: nothing stays for good")
        held = row["BytesOfTables"] + row["CacheCapacity"]
        check(held <= row["MemoryBudget"] == memory << 20, f"{what}: within the memory")
        check(row["BytesCached"] <= row["CacheCapacity"], f"{what}: the cache keeps within its capacity")


source = image_source(SCRIPT, EXTENT)
display = show(source, view, [0.7], "f", DSMMemory=256)
expected = go_round()
check(all(get_covered(picture).mean() > 0.05 for picture in expected), "something is shown")

# What is in memory goes to the disk when the memory is to be less.
display.DSMScratchDirectory = DISK
display.DSMMemory = 1
check_scratch(display, expected, 1, "less memory", is_told=True)
for organization in ("Object based", "Page based", "Replicated", "Automatic"):
    display.DSMMemoryOrganization = organization
    check_scratch(display, expected, 1, organization)
    check(os.listdir(DISK) == [], "files have no names")

# Refused without a scratch directory; tried again when there is one.
display.DSMScratchDirectory = ""
source.Script = source.Script.replace("0.05", "0.06")
with Messages() as messages:
    refused = render(view)
check(not get_covered(refused).any(), "nothing is drawn")
check("DSMScratchDirectory" in messages.text, f"it says what helps: {messages.text}")
display.DSMScratchDirectory = DISK
check(get_covered(render(view)).any(), "then it is there")

# Directories that are of no use: said once, and over when there is one.
missing = os.path.join(DISK, "missing")
display.DSMScratchDirectory = missing
source.Script = source.Script.replace("0.06", "0.04")
with Messages() as messages:
    refused = render(view)
    render(view)
text = messages.text
check(not get_covered(refused).any(), "nothing is drawn")
check(missing in text and " bytes" in text and "No such file" in text, f"directory, bytes and cause: {text}")
check(text.count("No such file") == 1, f"once: {text}")
os.makedirs(missing)
with Messages() as messages:
    again = render(view)
check(get_covered(again).any() and "ERROR" not in messages.text, f"the next frame works: {messages.text}")
simple.Delete(source)
render(view)

# Cells: their values are in blocks of their own. Refused without a scratch directory, too.
wavelet = simple.Wavelet(WholeExtent=[-30, 30] * 3)
cells = simple.Tetrahedralize(Input=wavelet)
display = show(cells, view, [150.0], "RTData", DSMMemory=256, DSMScratchDirectory="")
expected = go_round()
check(all(get_covered(picture).mean() > 0.05 for picture in expected), "cells are shown")
display.DSMMemory = 1
wavelet.Maximum = 256.0
with Messages() as messages:
    refused = render(view)
check(not get_covered(refused).any(), "cells: nothing is drawn")
check("DSMScratchDirectory" in messages.text, f"cells: it says what helps: {messages.text}")
wavelet.Maximum = 255.0
display.DSMScratchDirectory = DISK
check_scratch(display, expected, 1, "cells")
simple.Delete(cells)
simple.Delete(wavelet)
render(view)

# Meshes.
sphere = simple.Sphere(ThetaResolution=500, PhiResolution=500)
display = show_traced(sphere, view, DSMMemory=256, DSMScratchDirectory="")
expected = go_round()
display.DSMScratchDirectory = DISK
display.DSMMemory = 2
check_scratch(display, expected, 2, "mesh")
simple.Delete(sphere)
render(view)
shutil.rmtree(DISK)
