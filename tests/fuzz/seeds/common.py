# SPDX-License-Identifier: BSD-3-Clause
"""What the seeds have in common: a small volume, and where a seed goes."""

import os

import numpy as np

SHAPE = (6, 4, 5)  # z, y, x


def values(dtype="<f4", shape=SHAPE):
    return (np.arange(np.prod(shape)).reshape(shape) % 101).astype(dtype)


def path(folder, target, name):
    os.makedirs(os.path.join(folder, target), exist_ok=True)
    return os.path.join(folder, target, name)


def write(folder, target, name, content):
    with open(path(folder, target, name), "wb") as file:
        file.write(content.encode() if isinstance(content, str) else content)
