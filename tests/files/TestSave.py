# SPDX-License-Identifier: BSD-3-Clause
"""Save Data writes an image of which each rank has a piece as a brick file: every value comes back, for ParaView's
own programs and for h5py, and the same picture is drawn from it. Further arguments: a folder to write to, and a
Python that has h5py."""

import subprocess

from dsm_testing import *

load_plugin()
FOLDER, PYTHON = sys.argv[3:5]
EXTENT = (-3, 60, 2, 40, 5, 52)
source = image_source("""image.SetExtent(piece)
image.SetOrigin(1, 2, 3)
image.SetSpacing(1, 1, 2)
x, y, z = points(piece)
add(image, np.stack([x, y, z], axis=1).astype('i2'), 'place')
add(image, distance(piece).astype('f4'), 'f')
cells = [np.arange(piece[2 * axis], piece[2 * axis + 1]) for axis in (2, 1, 0)]
k, j, i = (axis.ravel() for axis in np.meshgrid(*cells, indexing='ij'))
array = numpy_to_vtk((i + 100 * j + 10000 * k).astype('i4'), deep=True)
array.SetName('cell')
image.GetCellData().AddArray(array)
array = numpy_to_vtk(np.stack([np.sin(i / 5.0), j / 30.0, k / 40.0], axis=1).astype('f4'), deep=True)
array.SetName('cells')
image.GetCellData().AddArray(array)
""", EXTENT, in_parts=True)
source.UpdatePipeline()

READ_BACK = """
import sys, h5py, numpy as np
with h5py.File(sys.argv[1]) as file:
    points, cells = file['VTKHDF/PointData'], file['VTKHDF/CellData']
    k, j, i = np.meshgrid(np.arange(5, 53), np.arange(2, 41), np.arange(-3, 61), indexing='ij')
    assert np.array_equal(points['place'][...], np.stack([i, j, k], axis=-1)), 'vectors'
    assert np.array_equal(cells['cell'][...], (i + 100 * j + 10000 * k)[:-1, :-1, :-1]), 'cells'
    assert points['f'].shape == (48, 39, 64) and points['f'].fletcher32, 'scalars'
    assert list(file['VTKHDF'].attrs['WholeExtent']) == [-3, 60, 2, 40, 5, 52], 'extent'
    assert file['DSM/PointData/f/BrickIndex'].shape[0] > 1, 'index'
"""


def save(name, **properties):
    with Messages() as messages:
        simple.SaveData(os.path.join(FOLDER, name), proxy=source, **properties)
    return messages.text.strip()


view = create_view()
view.UseFXAA = 0
first = show_traced(source, view, DSMIsoArray=["POINTS", "f"], DSMIsoValues=[0.8])
place_camera(view, (1.0, 0.3, 0.3))
expected = render(view)
check(get_covered(expected).any(), "the image is drawn")
OF_CELLS = [{"DSMIsoArray": ["CELLS", "cell"], "DSMIsoValues": [285000.0]},
            {"DSMIsoArray": ["CELLS", "cells"], "DSMIsoComponent": 0, "DSMIsoValues": [0.5]},
            {"DSMIsoArray": ["CELLS", "cells"], "DSMIsoComponent": 3, "DSMIsoValues": [1.4]}]


def render_cells(display):
    pictures = []
    for properties in OF_CELLS:
        for name, value in properties.items():
            setattr(display, name, value)
        pictures.append(render(view))
        check(get_covered(pictures[-1]).mean() > 0.02, f"{properties} shows something")
    return pictures


expected_cells = render_cells(first)
for name, properties in (("plain.h5", {}), ("pressed.h5", {"Compression": "Deflate"}),
                         ("zstd.h5", {"Compression": "Zstandard"})):
    said = save(name, **properties)
    check(said == "", f"{name}: nothing is reported: {said}")
    path = os.path.join(FOLDER, name)
    check(os.path.exists(path) and not os.path.exists(path + ".part"), f"{name}: there is a file")
    if name != "zstd.h5":
        subprocess.run([PYTHON, "-c", READ_BACK, path], check=True, timeout=60)
        check(True, f"{name}: h5py reads every value")
    reader = simple.DSMVolumeReader(FileName=path)
    reader.UpdatePipeline()
    check(reader.GetDataInformation().GetExtent() == EXTENT, f"{name}: the extent")
    simple.Hide(source, view)
    shown = show_traced(reader, view, DSMIsoArray=["POINTS", "f"], DSMIsoValues=[0.8])
    check_equal(render(view), expected, f"{name}: the same picture", tolerance=0)
    for picture, one in zip(render_cells(shown), expected_cells):
        check_equal(picture, one, f"{name}: the same picture of cells", tolerance=0)
    simple.Hide(reader, view)
    simple.Show(source, view)
first.DSMIsoArray, first.DSMIsoValues = ["POINTS", "f"], [0.8]
check(os.path.getsize(os.path.join(FOLDER, "pressed.h5")) < os.path.getsize(os.path.join(FOLDER, "plain.h5")),
      "compressed files are smaller")

# With coarser levels.
said = save("levels.h5", CoarserLevels=1)
check(said == "", f"coarser levels: nothing is reported: {said}")
path = os.path.join(FOLDER, "levels.h5")
subprocess.run([PYTHON, "-c", READ_BACK, path], check=True, timeout=60)
reader = simple.DSMVolumeReader(FileName=path, LevelofDetail=1)
reader.UpdatePipeline()
level = reader.GetDataInformation()
check(level.GetExtent() == (0, 31, 0, 19, 0, 23), f"a level of half the samples: {level.GetExtent()}")
# 64 x 39 x 48 samples from (-2, 4, 13) on, 1, 1 and 2 apart; the means of two lie between them.
check(level.GetBounds() == (-1.5, 60.5, 4.5, 42.5, 14, 106), f"where they are: {level.GetBounds()}")

# One array only.
said = save("one.h5", ChooseArraysToWrite=1, PointDataArrays=["f"], CellDataArrays=[])
check(said == "", f"one array is chosen: {said}")
reader = simple.DSMVolumeReader(FileName=os.path.join(FOLDER, "one.h5"))
reader.UpdatePipeline()
check(reader.PointData.keys() == ["f"] and not reader.CellData.keys(), "and written")

# A file that stays in its file while it is written anew.
said = save("plain.h5")
with Messages() as messages:
    simple.SaveData(os.path.join(FOLDER, "again.h5"), proxy=reader)
check(messages.text.strip() == "", "values that are in a file are written: " + messages.text)
again = simple.DSMVolumeReader(FileName=os.path.join(FOLDER, "again.h5"))
again.UpdatePipeline()
check(again.PointData["f"].GetRange() == reader.PointData["f"].GetRange(), "with their range")

# What cannot be written says why, and leaves nothing.
said = save("nowhere/x.h5")
check("nowhere/x.h5" in said, "a folder that is not there: " + said)
check_equal(render(view), expected, "and the session goes on", tolerance=0)
