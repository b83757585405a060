#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks who includes whom: the rooms of docs/architecture.md may only use the ones below them; and that
each module's CMakeLists.txt names its files."""
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)

# Folder -> patterns of includes that it must not have.
FORBIDDEN = {
    "vtk_modules/DSMCore": [
        r"^vtk", r"^glm/", r"^DSMBricks/", r"^DSMRayTracing/", r"^DSMVolumeFiles/", r"^RenderingDSM/",
    ],
    "vtk_modules/DSMBricks": [
        r"^vtk", r"^mpi\.h$", r"^hwy/", r"^DSMRayTracing/", r"^DSMVolumeFiles/", r"^RenderingDSM/",
    ],
    "vtk_modules/DSMRayTracing": [r"^vtk", r"^mpi\.h$", r"^DSMVolumeFiles/", r"^RenderingDSM/"],
    # Of the store, what an error and a message are, and who reads blocks.
    "vtk_modules/DSMVolumeFiles": [
        r"^vtk", r"^mpi\.h$", r"^RenderingDSM/", r"^DSMCore/(?!base/|transport/|fetch/BlockReader\.h)",
        r"^DSMRayTracing/",
    ],
    "vtk_modules/RenderingDSM": [r"^vtkPV", r"^vtkSM", r"^vtkSI", r"^mpi\.h$"],
    "plugin": [r"^mpi\.h$", r"^DSMCore/", r"^glm/"],
}
# Folder of a module -> its rooms, lowest first: a room uses itself and those before it.
ROOMS = {
    "vtk_modules/DSMCore": ["base", "transport", "memory", "publish", "fetch", "table", "paged", "store"],
    "vtk_modules/DSMBricks": ["base", "accel", "layout", "sorted", "build", "cells", "levels", "sample"],
    "vtk_modules/DSMRayTracing": [
        "base", "ray", "look", "object", "field", "surface", "slice", "medium", "mesh", "light", "scene", "schedule",
        "frame",
    ],
    "vtk_modules/DSMVolumeFiles": [
        "base", "codec", "format", "plain", "hdf", "remote", "zarr", "open", "cache", "range", "write",
    ],
    "vtk_modules/RenderingDSM": ["base", "options", "ranks", "file", "data", "part", "frame", "scene", "mapper"],
    "plugin/Representations": [
        "base", "paraview_before_6_0", "paraview_from_6_0", "settings", "domains", "session",
        "selection_and_export", "displays", "sources",
    ],
}
# Folder of a room -> its folders, lowest first, likewise; files beside them may use all.
FOLDERS = {"vtk_modules/DSMRayTracing/field": ["cells", "grid", "walk", "lattice", "levels", "tetrahedra"]}
MPI_FILE = "vtk_modules/DSMCore/transport/MpiTransport.cxx"


def find_faults(root):
    files = 0
    mpi_files = []
    for folder, patterns in FORBIDDEN.items():
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".h", ".cxx"):
                continue
            files += 1
            name = path.relative_to(root).as_posix()
            text = path.read_text()
            if not text.startswith("// SPDX-License-Identifier: BSD-3-Clause\n"):
                yield f"{name}: the licence line is missing"
            for include in INCLUDE.findall(text):
                if include == "mpi.h":
                    mpi_files.append(name)
                for pattern in patterns:
                    if re.search(pattern, include) and name != MPI_FILE:
                        yield f"{name}: includes {include}, which {folder} must not use"
    if mpi_files != [MPI_FILE]:
        yield f"mpi.h is included by {mpi_files}, not by {MPI_FILE} alone"
    if files < 50:
        yield f"only {files} files were found"


def find_arrows_back(root):
    for module, rooms in ROOMS.items():
        folder = root / module
        # VTK's headers are included by their bare names.
        room_of = {path.name: path.relative_to(folder).parts[0] for path in folder.rglob("vtk*.h")}
        for path in sorted(folder.rglob("*")):
            if path.suffix not in (".h", ".cxx", ".txx"):
                continue
            name = path.relative_to(root).as_posix()
            room = path.relative_to(folder).parts[0]
            if room not in rooms:
                yield f"{name}: {room} is no room of {module}"
                continue
            for include in INCLUDE.findall(path.read_text()):
                inside = include.startswith(f"{folder.name}/")
                used = include.split("/")[1] if inside else room_of.get(include)
                if used and used not in rooms[: rooms.index(room) + 1]:
                    yield f"{name}: includes {include}, but {room} must not use {used}"


def find_arrows_up(root):
    for room, folders in FOLDERS.items():
        for path in sorted((root / room).glob("*/*")):
            name = path.relative_to(root).as_posix()
            if path.parent.name not in folders:
                yield f"{name}: the room {room} does not list the folder {path.parent.name}"
                continue
            for used in re.findall(rf'"{room.removeprefix("vtk_modules/")}/(\w+)/', path.read_text()):
                if used not in folders[: folders.index(path.parent.name) + 1]:
                    yield f"{name}: uses {used}, which {path.parent.name} must not use"


def find_unlisted(root):
    for listing in (root / module / "CMakeLists.txt" for module in ROOMS):
        # Classes are listed by their path without a suffix, files by the whole.
        named = set(re.findall(r"[\w./-]+", listing.read_text()))
        for path in sorted(listing.parent.rglob("*")):
            name = path.relative_to(listing.parent).as_posix()
            if path.suffix in (".h", ".cxx", ".txx") and not named & {name, name[: -len(path.suffix)]}:
                yield f"{path.relative_to(root).as_posix()}: {listing.relative_to(root).as_posix()} does not name it"


def find_untold(root):
    """What docs/architecture.md says of the order of the rooms."""
    text = re.sub(r" +", " ", (root / "docs/architecture.md").read_text())
    for module, rooms in ROOMS.items():
        line = f"| {module.replace('vtk_modules/', '')} | {' '.join(rooms)} |"
        if f"\n{line}\n" not in text:
            yield f"docs/architecture.md does not have the line '{line}'"


def main():
    root = pathlib.Path(sys.argv[1])
    faults = [
        *find_faults(root), *find_arrows_back(root), *find_arrows_up(root), *find_unlisted(root), *find_untold(root),
    ]
    print("\n".join(faults) or "every room uses the rooms below it only, and every file is listed")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
