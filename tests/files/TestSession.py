# SPDX-License-Identifier: BSD-3-Clause
"""A session of steps that were drawn by lot: what is shown, and how, is the same on any number of ranks; what must not
matter to a picture, such as memory and threads, is drawn anew for each. All pictures are those of one rank, bit for
bit, and nothing is said. Called as run.py does, with the folder of make_files.py behind the other arguments."""

import os
import random
import sys

from dsm_testing import *

FILES = sys.argv[3]
STEPS = 30
CENTRE, EDGE = (24.0, 20.0, 18.0), 48.0  # of the volumes
os.environ["XDG_CACHE_HOME"] = os.path.join(OUTPUT, "caches", str(get_ranks()))
seen = random.Random(20051112)
unseen = random.Random(get_ranks())
UNSEEN = {
    "DSMMemoryOrganization": ("Automatic", "Replicated", "Object based", "Page based"),
    "DSMCacheSize": (1, 5, 1000),
    "DSMMemory": (0, 24, 200),
    "DSMThreads": (1, 2, 3),
    "DSMScheduler": ("Work stealing", "Central queue"),
}


def get_series(kind):
    return [os.path.join(FILES, f"play_{number:03}.{kind}") for number in range(4)]


SOURCES = {
    "series": lambda: simple.DSMVolumeReader(FileName=get_series("nhdr")),
    "steps": lambda: simple.DSMVolumeReader(FileName=os.path.join(FILES, "play.vtkhdf")),
    "image": lambda: simple.XMLImageDataReader(FileName=get_series("vti")),
    "mesh": lambda: simple.Superquadric(Scale=[0.4, 0.4, 0.4], ThetaResolution=40, PhiResolution=30),
}
sources = {}  # that there are, by name
shown = {}  # displays by source and view


def make(name, view):
    """Each has a place of its own, partly before the others."""
    number = list(SOURCES).index(name)
    place = (0.35 * number - 0.5, 0.1 * number, 0.2 - 0.25 * number)
    if name not in sources:
        sources[name] = SOURCES[name]()
    display = show_traced(sources[name], views[view])
    if name == "mesh":
        transform(display, translation=place)
    else:
        moved = [to - at / EDGE for to, at in zip(place, CENTRE)]
        transform(display, translation=moved, scale=[1.0 / EDGE] * 3)
        display.DSMIsoArray = ["POINTS", "play"]
        display.DSMIsoValue = 0.7
    shown[name, view] = display


def take_step():
    what = seen.choice(("visibility", "isovalue", "isovalues", "colour", "opacity", "light", "samples", "clip", "time",
                        "camera", "delete"))
    name = seen.choice(list(SOURCES)[:-1] if what.startswith("iso") else list(SOURCES))
    view = seen.randrange(len(views))
    number = seen.random()
    display = shown.get((name, view))
    if display is None:
        make(name, view)
        place_camera(views[view])
        return f"{name} comes to view {view}"
    if what == "visibility":
        display.Visibility = 1 - display.Visibility
    elif what == "isovalue":
        display.DSMIsoValues = []
        display.DSMIsoValue = 0.4 + 0.4 * number
    elif what == "isovalues":
        display.DSMIsoValues = [0.4 + 0.4 * number, 0.4 + 0.4 * seen.random()]
    elif what == "colour":
        display.AmbientColor = display.DiffuseColor = [number, 0.5, 1.0 - number]
    elif what == "opacity":
        display.Opacity = seen.choice((1.0, 0.5))
    elif what == "light":
        display.DSMShadows = int(number < 0.5)
        display.DSMAmbientOcclusionSamples = seen.choice((0, 2))
        display.DSMReflectivity = seen.choice((0.0, 0.3))
    elif what == "samples":
        display.DSMSamplesPerPixel = seen.choice((1, 3))
    elif what == "clip":
        display.DSMClip = 1 - display.DSMClip
        display.DSMClipNormal = [number, seen.random(), 0.5]
    elif what == "time":
        for each in views:
            each.ViewTime = float(int(4 * number))
    elif what == "camera":
        place_camera(views[view], (number - 0.5, 0.3, seen.choice((-1.0, 1.0))))
    elif what == "delete":
        simple.Delete(sources.pop(name))
        for key in [key for key in shown if key[0] == name]:
            del shown[key]
    return f"{what} of {name} in view {view}"


load_plugin()
views = [create_view(200, 160), create_view(200, 160)]
for view in range(len(views)):
    make("series", view)
    place_camera(views[view])
pictures = []
for step in range(STEPS):
    what = take_step()
    if shown and unseen.random() < 0.5:
        name = unseen.choice(list(UNSEEN))
        setattr(unseen.choice(list(shown.values())), name, unseen.choice(UNSEEN[name]))
    with Messages() as messages:
        found = []
        for view in views:
            view.UseFXAA = 0  # a new view has others forget theirs
            found.append(render(view))
    check("ERR" not in messages.text and "WARN" not in messages.text, f"{step}, {what}: {messages.text}")
    pictures.append(found)
kept = os.path.join(OUTPUT, "Session.npy")
if get_ranks() == 1:
    numpy.save(kept, pictures)
    changes = sum((before != after).any() for before, after in zip(numpy.array(pictures), numpy.array(pictures[1:])))
    check(changes > STEPS // 2, f"{changes} of {STEPS} steps are seen")
else:
    for step, (found, expected) in enumerate(zip(numpy.array(pictures), numpy.load(kept))):
        check((found == expected).all(), f"step {step} is as on one rank, bit for bit")
