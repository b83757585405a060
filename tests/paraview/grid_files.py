# SPDX-License-Identifier: BSD-3-Clause
"""Writes small files of cells of unlike kinds, in formats that ParaView has no writer for, or none that keeps kinds."""

import os

import numpy

SIZE = 8  # cells along each axis of a bent lattice
FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (3, 7, 6, 2), (0, 4, 7, 3), (1, 2, 6, 5)]  # outward, of a hexahedron
WAYS = [(0, 0, -1), (0, 0, 1), (0, -1, 0), (0, 1, 0), (-1, 0, 0), (1, 0, 0)]  # to the cell behind each face


def get_value(points):
    """A smooth function without a symmetry."""
    return numpy.linalg.norm((points - [4.3, 3.8, 4.1]) * [1.0, 1.1, 0.9], axis=1)


def make_points():
    k, j, i = (axis.ravel() for axis in numpy.meshgrid(*[numpy.arange(SIZE + 1.0)] * 3, indexing="ij"))
    waves = [numpy.sin(0.6 * j), numpy.sin(0.5 * k + 1.0), numpy.sin(0.8 * i)]
    return numpy.stack([i, j, k], axis=1) + 0.2 * numpy.stack(waves, axis=1)


def get_corners(i, j, k):
    x, y, z = 1, SIZE + 1, (SIZE + 1) ** 2
    first = i * x + j * y + k * z
    return [first, first + x, first + x + y, first + y, first + z, first + x + z, first + x + y + z, first + y + z]


def lines(values, width):
    return "".join(f"{value:{width}}\n" for value in values)


def write_ensight(folder):
    """One part, of hexahedra, wedges, pyramids and tetrahedra, with the point array f. Returns the file's name."""
    points = list(make_points())
    cells = {"hexa8": [], "penta6": [], "pyramid5": [], "tetra4": []}
    for k, j, i in numpy.ndindex(SIZE, SIZE, SIZE):
        at = get_corners(i, j, k)
        if i == SIZE // 2:  # along z from end to end: no triangle is beside a face of four corners
            cells["penta6"] += [[at[corner] for corner in wedge] for wedge in ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7))]
        elif (i + j + k) % 2:
            cells["hexa8"].append(at)
        else:
            points.append(sum(points[corner] for corner in at) / 8)
            faces = [[at[corner] for corner in reversed(face)] for face in FACES]
            # Tetrahedra behind the faces at the border alone: a diagonal of any other would be that of no neighbor.
            for face, way in zip(faces, WAYS):
                if 0 <= min(numpy.add((i, j, k), way)) and max(numpy.add((i, j, k), way)) < SIZE:
                    cells["pyramid5"].append(face + [len(points) - 1])
                else:
                    cells["tetra4"] += [[face[0], face[1], face[2], len(points) - 1],
                                        [face[0], face[2], face[3], len(points) - 1]]
    points = numpy.array(points)
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "kinds.geo"), "w", encoding="ascii") as text:
        text.write(f"kinds\nof cells\nnode id assign\nelement id assign\npart\n{1:10}\ncells\ncoordinates\n")
        text.write(f"{len(points):10}\n" + lines(points.T.ravel(), "12.5e"))
        for kind, ofKind in cells.items():
            text.write(f"{kind}\n{len(ofKind):10}\n")
            text.writelines("".join(f"{corner + 1:10}" for corner in cell) + "\n" for cell in ofKind)
    with open(os.path.join(folder, "kinds.f"), "w", encoding="ascii") as text:
        text.write(f"f\npart\n{1:10}\ncoordinates\n" + lines(get_value(points), "12.5e"))
    path = os.path.join(folder, "kinds.case")
    with open(path, "w", encoding="ascii") as text:
        text.write("FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: kinds.geo\nVARIABLE\nscalar per node: f kinds.f\n")
    return path


def write_open_foam_mesh(folder, layers):
    """A polyMesh of hexahedra and, of two of these each, of polyhedra with ten faces, and the values T of its cells."""
    points = make_points()
    numbers = {}
    count = 0
    for k in layers:
        for j, i in numpy.ndindex(SIZE, SIZE):
            isSecond = (j + k) % 2 == 1 and i % 2 == 1
            numbers[i, j, k] = numbers[i - 1, j, k] if isSecond else count
            count += 0 if isSecond else 1
    inner, outer = [], []
    centers = [[] for _ in range(count)]
    for at, number in numbers.items():
        corners = get_corners(*at)
        centers[number].append(points[corners].mean(axis=0))
        for face, way in zip(FACES, WAYS):
            other = numbers.get(tuple(numpy.add(at, way)))
            if other is None:
                outer.append((number, -1, [corners[corner] for corner in face]))
            elif other > number:
                inner.append((number, other, [corners[corner] for corner in face]))
    faces = sorted(inner) + sorted(outer)
    used = sorted({point for _, _, face in faces for point in face})
    new = {point: index for index, point in enumerate(used)}

    def write(place, name, kind, text):
        path = os.path.join(folder, place)
        os.makedirs(path, exist_ok=True)
        with open(os.path.join(path, name), "w", encoding="ascii") as file:
            file.write(f"FoamFile\n{{\nversion 2.0;\nformat ascii;\nclass {kind};\nobject {name};\n}}\n{text}\n")

    def write_list(name, kind, values):
        write("constant/polyMesh", name, kind, f"{len(values)}\n(\n" + "\n".join(values) + "\n)")

    write_list("points", "vectorField", ["(%.9g %.9g %.9g)" % tuple(points[point]) for point in used])
    write_list("faces", "faceList", [f"4({' '.join(str(new[point]) for point in face)})" for _, _, face in faces])
    write_list("owner", "labelList", [str(number) for number, _, _ in faces])
    write_list("neighbour", "labelList", [str(other) for _, other, _ in sorted(inner)])
    write_list("boundary", "polyBoundaryMesh",
               [f"walls\n{{\ntype wall;\nnFaces {len(outer)};\nstartFace {len(inner)};\n}}"])
    values = get_value(numpy.array([numpy.mean(center, axis=0) for center in centers]))
    write("1", "T", "volScalarField", "dimensions [0 0 0 1 0 0 0];\ninternalField nonuniform List<scalar>\n"
          f"{count}\n(\n" + "\n".join(f"{value:.9g}" for value in values) + "\n)\n;\n"
          "boundaryField\n{\nwalls\n{\ntype zeroGradient;\n}\n}")


def write_open_foam(folder):
    """A case of polyhedra and hexahedra, whole and decomposed for two processors. Returns the file's name."""
    write_open_foam_mesh(folder, range(SIZE))
    write_open_foam_mesh(os.path.join(folder, "processor0"), range(SIZE // 2))
    write_open_foam_mesh(os.path.join(folder, "processor1"), range(SIZE // 2, SIZE))
    os.makedirs(os.path.join(folder, "system"), exist_ok=True)
    with open(os.path.join(folder, "system", "controlDict"), "w", encoding="ascii") as text:
        text.write("FoamFile\n{\nversion 2.0;\nformat ascii;\nclass dictionary;\nobject controlDict;\n}\n"
                   "startFrom startTime;\nstartTime 1;\nendTime 1;\ndeltaT 1;\nwriteControl timeStep;\n"
                   "writeInterval 1;\nwriteFormat ascii;\n")
    path = os.path.join(folder, "case.foam")
    open(path, "w", encoding="ascii").close()
    return path
