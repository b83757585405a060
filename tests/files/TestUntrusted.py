# SPDX-License-Identifier: BSD-3-Clause
"""Numbers that a brick file or a kept file declares are checked: what cannot be right is found anew, or an error that
names the file. Save Data leaves the files of others alone. Files that grow are shown as far as they are. Further
arguments: a folder to write to, and a Python that has h5py."""

import fcntl
import glob
import shutil
import subprocess
import time

from dsm_testing import *

FOLDER, PYTHON = sys.argv[3:5]
shutil.rmtree(FOLDER, ignore_errors=True)
os.makedirs(FOLDER)
CACHES = os.path.join(FOLDER, "caches")
os.environ["XDG_CACHE_HOME"] = CACHES
load_plugin()
view = create_view()
view.UseFXAA = 0


def path(name):
    return os.path.join(FOLDER, name)


def run_h5py(name, script):
    script = script.replace("\n", "\n    ")
    script = f"import h5py, numpy as np, sys\nwith h5py.File(sys.argv[1], 'a') as f:\n    {script}"
    subprocess.run([PYTHON, "-c", script, path(name)], check=True, timeout=60)


def open_file(name):
    """What is reported, and the reader, and how long it takes."""
    start = time.monotonic()
    with Messages() as messages:
        reader = simple.DSMVolumeReader(FileName=path(name))
        reader.UpdatePipeline()
    return messages.text, reader, time.monotonic() - start


# Extents that VTK cannot count.
EXTENT = """g = f.create_group('VTKHDF')
g.attrs['Version'] = np.array([1, 0]); g.attrs['Type'] = np.bytes_('ImageData')
g.attrs['WholeExtent'] = np.array([{0}, {0} + 3, 0, 3, 0, 3], 'i8')
g.create_group('PointData').create_dataset('a', data=np.arange(64, dtype='f4').reshape(4, 4, 4), chunks=(2, 2, 2))"""
for number, first in enumerate((-(1 << 32), -(1 << 31) - 1, (1 << 31) - 4, 1 << 32, -(1 << 62), (1 << 62))):
    name = f"extent{number}.vtkhdf"
    run_h5py(name, EXTENT.format(first))
    said, reader, took = open_file(name)
    check(name in said and took < 5, f"an extent that begins at {first}: {said.strip()}")
    simple.Delete(reader)
for number, first in enumerate((-(1 << 31), (1 << 31) - 5, -2)):
    name = f"sound{number}.vtkhdf"
    run_h5py(name, EXTENT.format(first))
    said, reader, took = open_file(name)
    check(said == "" and reader.GetDataInformation().GetExtent()[:2] == (first, first + 3),
          f"one that begins at {first}: {said}")
    check(reader.PointData["a"].GetRange() == (0.0, 63.0), "and its range")
    simple.Delete(reader)

# What a brick file says of its values.
source = image_source("image.SetExtent(piece)\nadd(image, distance(piece).astype('f4'), 'f')", (0, 40, 0, 36, 0, 33),
                      in_parts=True)
source.UpdatePipeline()
simple.SaveData(path("whole.h5"), proxy=source)
said, reader, _ = open_file("whole.h5")
check(said == "", f"a brick file is written and opened: {said}")
true_range = reader.PointData["f"].GetRange()
show_traced(reader, view, DSMIsoArray=["POINTS", "f"], DSMIsoValues=[0.8])
place_camera(view)
expected = render(view)
check(get_covered(expected).any(), "the image is drawn")
simple.Delete(reader)
GROUP = "DSM/PointData/f"
DAMAGES = {
    "ranges of NaN": "f['%s/ValueRanges'][...] = np.nan" % GROUP,
    "ranges the wrong way round": "f['%s/ValueRanges'][...] = [[2, 1, 2, 1]]" % GROUP,
    "ranges beyond their type": "f['%s/ValueRanges'][...] = [[-np.inf, np.inf, -np.inf, np.inf]]" % GROUP,
    "finite ranges outside of all": "f['%s/ValueRanges'][...] = [[0, 1, -5, 5]]" % GROUP,
    "ranges of another number": "del f['{0}/ValueRanges']; f['{0}/ValueRanges'] = np.zeros((7, 4))".format(GROUP),
    "an index of zeros": "f['%s/BrickIndex'][...] = 0" % GROUP,
    "an index with one other byte": "f['%s/BrickIndex'][50] ^= 1" % GROUP,
    "half an index": "i = f['{0}/BrickIndex'][...]; del f['{0}/BrickIndex']; "
                     "f['{0}/BrickIndex'] = i[: i.size // 2]".format(GROUP),
    "an index of floats": "del f['{0}/BrickIndex']; f['{0}/BrickIndex'] = np.full(4096, 1e300)".format(GROUP),
    "an edge of 0": "f['DSM'].attrs['BrickEdge'] = 0",
    "an edge below 0": "f['DSM'].attrs['BrickEdge'] = -16",
    "a large edge": "f['DSM'].attrs['BrickEdge'] = 2 ** 31 - 1",
    "an edge beyond int": "f['DSM'].attrs['BrickEdge'] = 2 ** 40",
}
# A survey with numbers that nobody counted, and a checksum that fits: the hash of dsm::HashBytes.
FORGED = """i = f['%s/BrickIndex'][...].tobytes()
n = (len(i) - 8 - {0}) // 24
at = 8 * n
survey = np.frombuffer(i[at : at + {0}], '<i8').copy()
survey[{1}] = {2}
i = i[:at] + survey.tobytes() + i[at + {0} : -8]
import ctypes
hash = ctypes.CDLL('libxxhash.so.0').XXH3_64bits_withSeed
hash.restype = ctypes.c_uint64
h = hash(i, ctypes.c_size_t(len(i)), ctypes.c_uint64(0))
f['%s/BrickIndex'][...] = np.frombuffer(i + h.to_bytes(8, 'little'), 'u1')""" % (GROUP, GROUP)
SURVEY = 8 * (3 * 512 + 4) + 16
for what, place, number in (("a count outside of its range", 511, 0x4141414141),
                            ("a first interval", 3 * 512 + 2, 1 << 62),
                            ("an exponent", 3 * 512 + 3, -(1 << 63)), ("counts below 0", 0, -1)):
    DAMAGES["a forged survey: " + what] = FORGED.format(SURVEY, place, number)
DAMAGES["a forged survey that is sound"] = FORGED.format(SURVEY, 511, 0)
for number, (what, damage) in enumerate(DAMAGES.items()):
    shutil.rmtree(CACHES, ignore_errors=True)
    name = f"damaged{number}.h5"
    shutil.copy(path("whole.h5"), path(name))
    run_h5py(name, damage)
    said, reader, took = open_file(name)
    found = reader.PointData["f"].GetRange()
    infinite = "beyond" in what  # which values of a float may be
    check(said == "" and (infinite or found == true_range) and took < 5, f"{what}: the range is found: {found} {said}")
    with Messages() as messages:
        display = show_traced(reader, view, DSMIsoArray=["POINTS", "f"], DSMIsoValues=[0.8])
        place_camera(view)
        picture = render(view)
    check(messages.text == "", f"{what}: {messages.text}")
    check_equal(picture, expected, f"{what}: the picture", tolerance=0)
    display.DSMIsoValues = []
    with Messages() as messages:
        render(view)
    check(messages.text == "", f"{what}: an isovalue is chosen: {messages.text}")
    simple.Delete(reader)

# What is kept of a file that has no ranges of its own.
shutil.rmtree(CACHES, ignore_errors=True)
run_h5py("plain.h5", "f['values'] = np.linspace(2, 9, 4096, dtype='f4').reshape(16, 16, 16)")
for what, damage in (("nothing is kept yet", None), ("kept, and whole", lambda name: None),
                     ("filled with zeros", lambda name: open(name, "r+b").write(bytes(os.path.getsize(name)))),
                     ("cut off", lambda name: os.truncate(name, 20)),
                     ("large", lambda name: os.truncate(name, 1 << 36)),
                     ("a pipe", lambda name: (os.remove(name), os.mkfifo(name))),
                     ("a folder", lambda name: (os.remove(name), os.mkdir(name)))):
    for kept in glob.glob(os.path.join(CACHES, "dsm-ray-tracer", "*")):
        if damage:
            damage(kept)
    said, reader, took = open_file("plain.h5")
    found = reader.PointData["values"].GetRange()
    check(said == "" and found == (2.0, 9.0) and took < 5, f"kept ranges, {what}: {found} {said}")
    simple.Delete(reader)
    if damage and "pipe" in what:
        shutil.rmtree(CACHES)


# Save Data removes only what it began.
def save(name):
    start = time.monotonic()
    with Messages() as messages:
        simple.SaveData(path(name), proxy=source)
    return messages.text.strip(), time.monotonic() - start


def list_folder():
    return {name: os.lstat(path(name)).st_size for name in os.listdir(FOLDER) if name.startswith("taken")}


def write(name, content):
    with open(path(name), "wb") as file:
        file.write(content)


def expect_refusal(what, *words):
    before = list_folder()
    said, took = save("taken.h5")
    check(all(word in said for word in ("taken.h5", *words)) and took < 5, f"{what}: {said}")
    check(list_folder() == before, f"{what}: all files stay: {before}")


STATE = b'{"whole": %s, "of": {"source": "another file"}, "chunks": [%d]%s}'
write("taken.h5.part.json", STATE % (b"true", 7, b""))
write("taken.h5.part", b"chunks")
write("taken.h5.part.level1", b"a level")
expect_refusal("a conversion that can be resumed", "Run dsm_convert again", "taken.h5.part.json")
with open(path("taken.h5.part.lock"), "wb") as lock:
    fcntl.flock(lock, fcntl.LOCK_EX)
    expect_refusal("a conversion that is running", "is being written by another process")
os.remove(path("taken.h5.part.lock"))
os.remove(path("taken.h5.part.json"))
expect_refusal("another program's files", "this program did not create it")
os.remove(path("taken.h5.part"))
expect_refusal("another program's level", "taken.h5.part.level1")
os.remove(path("taken.h5.part.level1"))
for name in ("taken.h5.part", "taken.h5.part.json", "taken.h5.part.lock", "taken.h5"):
    os.mkfifo(path(name))
    expect_refusal("a pipe as " + name, name)
    os.remove(path(name))
    os.mkdir(path(name))
    expect_refusal("a folder as " + name, name)
    os.rmdir(path(name))
# What nobody can resume is replaced.
for state in (STATE % (b"false", 7, b""), STATE % (b"true", 0, b""), STATE % (b"true", 7, b', "resumable": false'),
              b"{", b"\0" * 99):
    write("taken.h5.part.json", state)
    write("taken.h5.part", b"chunks")
    said, _ = save("taken.h5")
    check(said == "" and list(list_folder()) == ["taken.h5"], f"a state that nobody can resume ({state[:40]}): {said}")
    os.remove(path("taken.h5"))
# Names of arrays.
NAMES = ("x" * 200, "%s%n", "caf\u00e9", "a/b", ".")
source.Script = source.Script + "".join(f"\nadd(image, distance(piece).astype('f4') + {number}, {name!r})"
                                        for number, name in enumerate(NAMES))
said, _ = save("taken.h5")
check(said == "", f"names of arrays are written: {said}")
said, reader, _ = open_file("taken.h5")
for number, name in enumerate(NAMES):
    found = reader.PointData[{"a/b": "a_b", ".": "_"}.get(name, name)]
    check(found is not None and abs(found.GetRange()[1] - true_range[1] - number) < 1e-5, f"the array {name[:20]}")
simple.Delete(reader)
os.remove(path("taken.h5"))
for name in ("taken caf\u00e9 %s%n.h5", "taken" + "x" * 235 + ".h5"):
    said, _ = save(name)
    check(said == "" and list(list_folder()) == [name], f"a name such as {name[:20]}: {said}")
    said, reader, _ = open_file(name)
    check(said == "" and reader.PointData["f"].GetRange() == true_range, "and it is read")
    simple.Delete(reader)
    os.remove(path(name))

# A file to which another program appends (SWMR): what is there is shown, and more after Reload Files.
APPEND = """
import h5py, sys
file = h5py.File(sys.argv[1], "w", libver="latest")
values = file.create_dataset("v", (0, 16, 16, 16), "f4", maxshape=(None, 16, 16, 16), chunks=(1, 8, 16, 16))
if sys.argv[2] == "swmr":
    file.swmr_mode = True
for line in sys.stdin:
    step = values.shape[0]
    values.resize(step + 1, 0)
    values[step] = step
    values.flush()
    print(step, flush=True)
"""


class Writer:
    def __init__(self, name, mode):
        command = [PYTHON, "-c", APPEND, path(name), mode]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def append(self, steps):
        for _ in range(steps):
            self.process.stdin.write("\n")
            self.process.stdin.flush()
            self.process.stdout.readline()

    def kill(self):
        self.process.kill()
        self.process.wait()


writer = Writer("live.h5", "swmr")
writer.append(3)
said, reader, _ = open_file("live.h5")
check(said == "" and list(reader.TimestepValues) == [0, 1, 2], f"a file that grows has its steps: {said}")
reader.UpdatePipeline(2)
check(reader.PointData["v"].GetRange(0) == (2, 2), "and their values")
writer.append(1)
simple.ReloadFiles(reader)
reader.UpdatePipelineInformation()
reader.UpdatePipeline(3)
check(len(reader.TimestepValues) == 4 and reader.PointData["v"].GetRange(0) == (3, 3), "Reload Files shows more")
simple.Delete(reader)
writer.kill()
said, reader, _ = open_file("live.h5")
check(said == "" and len(reader.TimestepValues) == 4, f"also after its writer was killed: {said}")
simple.Delete(reader)
writer = Writer("torn.h5", "")
writer.append(1)
writer.kill()
said, reader, _ = open_file("torn.h5")
check("torn.h5" in said and "h5clear" in said, f"a file of a killed writer has an error that says what to run: {said}")
simple.Delete(reader)
