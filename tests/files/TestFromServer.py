# SPDX-License-Identifier: BSD-3-Clause
"""Volumes on a server look as those in their folder, bit for bit; what is wrong with the server is said by all ranks
together, and the last picture stays. Called as run.py does, with the folder of make_files.py, the server and a folder
for what is kept, which all ranks have in XDG_CACHE_HOME, behind the other arguments."""

import collections
import shutil
import subprocess
import urllib.request

from dsm_testing import *

FILES, PYTHON, SERVER, KEPT = sys.argv[3:7]
os.environ["XDG_CACHE_HOME"] = KEPT
shutil.rmtree(os.path.join(KEPT, "dsm-ray-tracer"), ignore_errors=True)
load_plugin()
view = create_view()
environment = {name: value for name, value in os.environ.items() if not name.startswith(("OMPI", "PMIX"))}
process = subprocess.Popen([PYTHON, SERVER, FILES], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment)
port = int(process.stdout.readline())


def get_url(behavior, name):
    return f"http://127.0.0.1:{port}/{behavior}/{name}"


def take_log():
    with urllib.request.urlopen(get_url("log", "x"), timeout=10) as answer:
        return json.load(answer)


def picture(path, array, organization):
    source = simple.DSMVolumeReader(FileName=path)
    display = show(source, view, [0.7], array, DSMMemoryOrganization=organization)
    place_camera(view)
    pixels = render(view)
    simple.Delete(display)
    simple.Delete(source)
    return pixels


# Version 2, blocks that are missing, and version 3 with shards.
for name in ("ball.zarr", "holes.zarr", "three_sharded.zarr"):
    array = name.partition(".")[0]
    expected = picture(os.path.join(FILES, name), array, "Object based")
    for organization in ("Object based", "Replicated"):
        take_log()
        with Messages() as messages:
            traced = picture(get_url("ok", name), array, organization)
        check("ERROR" not in messages.text, f"{name}, {organization}: no error: {messages.text}")
        check(get_covered(traced).any() or name != "ball.zarr", f"{name}: something is shown")
        check((traced == expected).all(), f"{name}, {organization}: as from the folder, bit for bit")
        counts = collections.Counter((one[1], one[2]) for one in take_log() if one[4] in (200, 206))
        check(max(counts.values(), default=1) == 1, f"{name}, {organization}: no rank fetches what another one has")
        check(organization == "Replicated" or len(counts) > 1, f"{name}: it came from the server")

source = simple.OpenDataFile(get_url("ok", "ball.zarr"))
check(source.SMProxy.GetXMLName() == "DSMVolumeReader", "OpenDataFile takes an address")
source.UpdatePipeline()
check(abs(source.PointData["ball"].GetRange(0)[1] - 3**0.5) < 1e-6, "and its values are there")
simple.Delete(source)

# What is said, and by whom it is noticed, does not matter: all ranks go on.
last = render(view)
for behavior, words in (("403", "403 Forbidden"), ("cut", "transfer closed"), ("other_bytes", "cannot be read")):
    with Messages() as messages:
        source = simple.DSMVolumeReader(FileName=get_url(behavior, "ball.zarr"))
        display = show(source, view, [0.7], "ball")
        render(view)
    check(get_url(behavior, "ball.zarr") in messages.text, f"{behavior}: the address is named: {messages.text}")
    check(words in messages.text, f"{behavior}: the cause is named: {messages.text}")
    simple.Delete(display)
    simple.Delete(source)
for url, words in (
    (get_url("ok", "nothing.zarr"), "404 Not Found"), ("http://127.0.0.1:1/x.zarr", "connect"),
    ("https://host/volume.h5", "Copy the file"), ("https://me:geheim@host/x.zarr", "~/.netrc"),
):
    with Messages() as messages:
        source = simple.DSMVolumeReader(FileName=url)
        source.UpdatePipeline()
    check(words in messages.text, f"{url}: the cause is named: {messages.text}")
    check("geheim" not in messages.text, "no password is shown")
    simple.Delete(source)
check((picture(get_url("ok", "ball.zarr"), "ball", "Automatic")
       == picture(os.path.join(FILES, "ball.zarr"), "ball", "Automatic")).all(), "then all is as before")
process.stdin.close()
process.wait(10)
