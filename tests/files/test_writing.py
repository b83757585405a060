# SPDX-License-Identifier: BSD-3-Clause
"""dsm_convert with names of any bytes, and with other programs' files, pipes and damaged files in its way. Each case
gives the right file, or an error that names file and cause, soon. Called as test_writing.py DSM_CONVERT FOLDER."""

import glob
import json
import os
import resource
import shutil
import signal
import stat
import subprocess
import sys
import time

import h5py
import numpy as np

CONVERT, FOLDER = sys.argv[1], sys.argv[2]
failed = False


def check(condition, what):
    global failed
    failed = failed or not condition
    print(("passed: " if condition else "FAILED: ") + what, flush=True)


shutil.rmtree(FOLDER, ignore_errors=True)
os.makedirs(FOLDER)
os.chdir(FOLDER)
values = np.arange(24 * 20 * 18, dtype="<f4").reshape(18, 20, 24)
values.tofile("values.raw")
BARE = ["--raw-size", "24,20,18", "--raw-type", "float32"]


def convert(*options, quiet=True, **more):
    """Names are str or bytes. What the command says, without its own name; the cases are small, so it is soon."""
    start = time.monotonic()
    done = subprocess.run([CONVERT, *(["--quiet"] if quiet else []), *map(os.fsencode, options)], capture_output=True,
                          timeout=60, errors="surrogateescape", **more)
    done.took = time.monotonic() - start
    return done


def refuses(what, words, *options, **more):
    done = convert(*options, **more)
    said = done.stderr.strip()
    check(done.returncode == 1 and all(word in said for word in words) and done.took < 5,
          f"{what} ({done.took:.1f} s): {ascii(said)}")


def get_values(name, array="PointData/values"):
    with h5py.File(name, "r") as file:
        return file["VTKHDF"][array][...]


def list_beside(name):
    return sorted(other for other in os.listdir(b".") if other.startswith(os.fsencode(name))
                  and other != os.fsencode(name))


# Names of files that are not UTF-8, have a % or are long.
for name in (b"b\xe9ta", b"%s%n%b", b"caf\xc3\xa9", b"a" * 240, b"\xff" * 230, b"with space\nand line"):
    shutil.copy(b"values.raw", name + b".raw")
    for levels in ("0", "all"):
        done = convert("--levels", levels, "--brick", "4", *BARE, name + b".raw", name + b".h5")
        check(done.returncode == 0 and done.stderr == "", f"{name[:20]}: it is written: {ascii(done.stderr)}")
        check(list_beside(name + b".h5") == [], f"{name[:20]}: nothing is left beside it")
        os.rename(name + b".h5", b"renamed.h5")
        check(np.array_equal(next(iter(h5py.File("renamed.h5", "r")["VTKHDF/PointData"].values()))[...], values),
              f"{name[:20]}: every value")
    os.remove(name + b".raw")
refuses("a name that is too long", ["File name too long"], *BARE, "values.raw", "x" * 300 + ".h5")
refuses("an input whose name is too long", ["xxx", "File name too long"], *BARE, "x" * 300 + ".raw", "x.h5")
refuses("a folder that is not there", ["nowhere/%s.h5", "No such file or directory"], *BARE, "values.raw",
        "nowhere/%s.h5")

# Names of arrays.
NAMES = (b"\xe9t\xe9", b"%s%n%d", b"caf\xc3\xa9", b"..", b"a" * 255, b"two\nlines", b"Cr\xc3\xb6\xff")
with h5py.File("names.h5", "w") as file:
    for number, name in enumerate(NAMES):
        file.create_dataset(name, data=values + number)
done = convert("names.h5", "named.h5")
check(done.returncode == 0, f"names of arrays: {ascii(done.stderr)}")
if done.returncode == 0:
    with h5py.File("named.h5", "r") as file:
        for number, name in enumerate(NAMES):
            points = file["VTKHDF/PointData"]
            check(np.array_equal(points[name][...], values + number), f"the array {name[:20]}")
            check(len(file["DSM/PointData"][name]["BrickIndex"]) > 0, f"the index of {name[:20]}")
done = convert("--arrays", NAMES[0] + b"," + NAMES[1], "names.h5", "chosen.h5")
with h5py.File("chosen.h5", "r") as file:
    check(len(file["VTKHDF/PointData"]) == 2, f"chosen by names of any bytes: {ascii(done.stderr)}")
with h5py.File("vtk.h5", "w") as file:
    image = file.create_group("VTKHDF")
    image.attrs["Version"], image.attrs["Type"] = np.array([1, 0]), np.bytes_("ImageData")
    image.attrs["WholeExtent"] = np.array([0, 23, 0, 19, 0, 17])
    points = image.create_group("PointData")
    for name in NAMES:
        points.create_dataset(name, data=values)
done = convert("vtk.h5", "of_vtk.h5")
check(done.returncode == 0, f"VTK's image with such names: {ascii(done.stderr)}")

# Options.
for option, number in (("--threads", "1000000000"), ("--memory", "99999999999999999999"), ("--memory", str(1 << 60)),
                       ("--brick", "1e9"), ("--brick", "1000000"), ("--step", "-1"), ("--step", "7"),
                       ("--level", "99999999999"),
                       ("--raw-header", "-5"), ("--spacing", "0,5;1;1"), ("--spacing", "nan,1,1"),
                       ("--spacing", "1e999,1,1")):
    refuses(f"{option} {number}", ["dsm_convert: "], option, number, *BARE, "values.raw", "options.h5")
check(list_beside("options.h5") == [] and not os.path.exists("options.h5"), "nothing is left of refused options")
done = convert("--spacing", "0.5,1.25,1e-3", *BARE, "values.raw", "spacing.h5",
               env={**os.environ, "LC_ALL": "de_DE.UTF-8"})
with h5py.File("spacing.h5", "r") as file:
    check(list(file["VTKHDF"].attrs["Spacing"]) == [0.5, 1.25, 1e-3], "numbers have a point in every locale")

# Several time steps, of which one is written.
with h5py.File("steps.h5", "w") as file:
    file.create_dataset("values", data=np.stack([values + step for step in range(5)]))
done = convert("steps.h5", "step.h5")
check(done.returncode == 0 and "'steps.h5' has 5 time steps (0 to 4); only step 0 is written" in done.stderr,
      f"a note of the other steps: {done.stderr.strip()}")
done = convert("--step", "3", "steps.h5", "step.h5")
check(done.returncode == 0 and done.stderr == "" and np.array_equal(get_values("step.h5"), values + 3),
      "none with --step")

# A chunk that does not fit the memory.
with h5py.File("large.h5", "w") as file:
    large = file.create_dataset("v", shape=(2048, 1024, 512), chunks=(1024, 1024, 512), dtype="f4", compression="gzip")
    large.id.write_direct_chunk((0, 0, 0), b"no deflate stream")
refuses("a chunk of 2 GiB in 1.5 GB of memory", ["out of memory", "'v'", "'large.h5'"], "large.h5", "small.h5",
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (1500000000, 1500000000)))

# What is in the way belongs to others, and stays.
def make_file(name):
    with open(name, "wb") as file:
        file.write(b"mine")


def make_device(name):
    os.symlink("/dev/zero", name)


def get_kind(name):
    return stat.S_IFMT(os.lstat(name).st_mode)


def remove(name):
    shutil.rmtree(name) if get_kind(name) == stat.S_IFDIR else os.remove(name)


for suffix in ("part", "part.json", "part.lock", "part.level1", "part.level1.part", "part.json.new"):
    for make in (make_file, os.mkfifo, os.mkdir, make_device):
        name = "way.h5." + suffix
        make(name)
        kind = get_kind(name)
        # Regular files of these names are left by this program, or are damaged states of it.
        if make is make_file and suffix in ("part.json", "part.level1.part", "part.json.new"):
            os.remove(name)
            continue
        refuses(f"{make.__name__} as {suffix}", ["way.h5.part"], "--levels", "1", "--brick", "4", *BARE, "values.raw",
                "way.h5")
        check(get_kind(name) == kind and (make is not make_file or open(name, "rb").read() == b"mine"), "and it stays")
        remove(name)
        if suffix == "part.level1.part":  # the finest level is whole then, and waits for a later call
            done = convert("--levels", "1", "--brick", "4", *BARE, "values.raw", "way.h5")
            check(done.returncode == 0, f"a later call goes on: {done.stderr.strip()}")
            os.remove("way.h5")
        check(list_beside("way.h5") == [] and not os.path.exists("way.h5"), "nothing else is left")
refuses("a device to write to", ["'/dev/full'"], *BARE, "values.raw", "/dev/full")
os.mkfifo("pipe.raw")
refuses("a pipe to read from", ["pipe.raw"], *BARE, "pipe.raw", "pipe.h5")

# A conversion that is killed, whose files are then damaged, begins anew.
many = np.arange(160 ** 3, dtype="<f4").reshape(160, 160, 160)
many.tofile("many.raw")
MANY = ["--raw-size", "160,160,160", "--raw-type", "float32", "many.raw", "many.h5"]


def get_chunks():
    try:
        with open("many.h5.part.json") as file:
            return json.load(file)["chunks"][0]
    except (OSError, ValueError):
        return 0


process = subprocess.Popen([CONVERT, "--quiet", "--memory", "2", *MANY])
while get_chunks() < 200 and process.poll() is None:
    time.sleep(0.002)
process.kill()
check(process.wait() == -signal.SIGKILL and get_chunks() >= 200, "a conversion is killed")
kept = {name: open(name, "rb").read() for name in glob.glob("many.h5.part*")}
state = json.loads(kept["many.h5.part.json"])


def change_state(**changes):
    with open("many.h5.part.json", "w") as file:
        json.dump({**state, **changes}, file)


def change_part(change):
    with h5py.File("many.h5.part", "r+") as file:
        change(file)


def replace(name, **dataset):
    def change(file):
        del file[name]
        file.create_dataset(name, **dataset)
    return lambda: change_part(change)


def write(name, content, size=None):
    with open(name, "wb") as file:
        file.write(content)
        file.truncate(size)


with h5py.File("many.h5.part", "r") as file:
    ARRAY = next(iter(file["VTKHDF/PointData"]))
INDEX = f"DSM/PointData/{ARRAY}/"
STATE, PART = "many.h5.part.json", "many.h5.part"
DAMAGES = {
    "a negative count": lambda: change_state(chunks=[-1]),
    "too many chunks": lambda: change_state(chunks=[1001]),
    "a count beyond 64 bits": lambda: change_state(chunks=[1 << 64]),
    "a count of 2^63": lambda: change_state(chunks=[1 << 63]),
    "a count that is no integer": lambda: change_state(chunks=[1.5]),
    "a count that is a word": lambda: change_state(chunks=["200"]),
    "no counts": lambda: change_state(chunks=[]),
    "counts that are no list": lambda: change_state(chunks={"0": 1}),
    "no chunks": lambda: change_state(chunks=None),
    "two counts": lambda: change_state(chunks=[1, 1]),
    "whole that is a word": lambda: change_state(whole="true"),
    "a state that is a list": lambda: write(STATE, b"[1, 2]"),
    "an empty state": lambda: write(STATE, b""),
    "half a state": lambda: write(STATE, kept[STATE][:100]),
    "zeros": lambda: write(STATE, bytes(len(kept[STATE]))),
    "bytes that are not UTF-8": lambda: write(STATE, kept[STATE].replace(b"many", b"\xff\xfe")),
    "a state that is nested deeply": lambda: write(STATE, b"[" * 10000000),
    "objects that are nested deeply": lambda: write(STATE, b'{"of":' * 1000000),
    "a state of 5 GiB": lambda: write(STATE, kept[STATE], 5 << 30),
    "no part": lambda: os.remove(PART),
    "an empty part": lambda: write(PART, b""),
    "half a part": lambda: write(PART, kept[PART][:3000]),
    "ranges of another size": replace(INDEX + "ValueRanges", data=np.full((1 << 16, 4), 7.0)),
    "ranges that are huge": replace(INDEX + "ValueRanges", shape=(1 << 40, 4), chunks=(1 << 10, 4), dtype="f8"),
    "ranges that are words": replace(INDEX + "ValueRanges", data=np.array([[b"a", b"b", b"c", b"d"]])),
    "no ranges": lambda: change_part(lambda file: file.__delitem__(INDEX + "ValueRanges")),
    "ranges of NaN": lambda: change_part(lambda file: file[INDEX + "ValueRanges"].__setitem__(..., np.nan)),
    "a range the wrong way round": lambda: change_part(
        lambda file: file[INDEX + "ValueRanges"].__setitem__(..., [[2, 1, 2, 1]])),
    "halos of another size": replace(INDEX + "Halos", shape=(1000, 3), chunks=(1, 3), dtype="u1"),
    "values of another shape": replace("VTKHDF/PointData/" + ARRAY, shape=(16, 16, 16), chunks=(16, 16, 16),
                                       dtype="f4"),
}
for what, damage in DAMAGES.items():
    for name, content in kept.items():
        write(name, content)
    damage()
    done = convert("--memory", "64", *MANY)
    right = done.returncode == 0 and np.array_equal(get_values("many.h5", "PointData/" + ARRAY), many)
    check(right and done.took < 10, f"{what} ({done.took:.1f} s): it is begun anew: {ascii(done.stderr.strip())}")
    check(list_beside("many.h5") == [], f"nothing is left {list_beside('many.h5')}")
    for name in glob.glob("many.h5*"):
        os.remove(name)

# Another name does not touch it.
for name, content in kept.items():
    write(name, content)
done = convert(*BARE, "values.raw", "many.h5.part.h5")
check(done.returncode == 0 and all(open(name, "rb").read() == content for name, content in kept.items()),
      "a file beside it leaves a conversion as it is")
done = convert("--memory", "64", *MANY)
check(done.returncode == 0 and np.array_equal(get_values("many.h5", "PointData/" + ARRAY), many),
      "which is finished then")
shutil.rmtree(FOLDER)
sys.exit(failed)
