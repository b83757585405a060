# SPDX-License-Identifier: BSD-3-Clause
"""What is common to the volumes that make_files.py makes, in the folder that its argument names."""

import os
import shutil
import sys

import numpy as np

SIZE = (21, 13, 10)  # x, y, z
folder = sys.argv[1]
shutil.rmtree(folder, ignore_errors=True)
os.makedirs(folder)
entries = []


def values(dtype, components=1, channel=0, step=0, size=SIZE):
    """z, y, x, and c when there are several."""
    z, y, x = np.meshgrid(*(np.arange(n) for n in reversed(size)), indexing="ij")
    base = 3 * x + 5 * y + 7 * z + 11 * channel + 13 * step
    if components > 1:
        base = base[..., np.newaxis] + np.arange(components)
    return (base % 101).astype(dtype)


def path(name):
    return os.path.join(folder, name)


def create_image(file, size=SIZE, version=(1, 0)):
    """The group of a VTKHDF file's image; where it is, counts from 0."""
    group = file.create_group("VTKHDF")
    group.attrs["Version"], group.attrs["Type"] = version, np.bytes_("ImageData")
    group.attrs["WholeExtent"] = [limit for n in size for limit in (0, n - 1)]
    return group


def note(name, arrays, **more):
    """arrays: name (None: as the file is called), type, components, channel, on cells, without time."""
    keys = ("name", "type", "components", "channel", "cells", "still")
    defaults = (None, None, 1, 0, False, False)
    listed = [dict(zip(keys, (*array, *defaults[len(array) :]))) for array in arrays]
    for array in listed:
        array["name"] = array["name"] or os.path.splitext(name)[0]
    entry = {"file": name, "arrays": listed, "steps": 1, "level": 0, "dataset": "", "size": SIZE}
    entries.append({**entry, **more})
