# SPDX-License-Identifier: BSD-3-Clause
"""How the ranks keep their bricks: the picture is the same whatever the user chooses, what Automatic
chooses is logged once, and what does not fit the memory is refused with what would."""

from dsm_testing import *
from vtkmodules.vtkCommonCore import vtkLogger

load_plugin()
EXTENT = (0, 89, 0, 89, 0, 89)  # doubles: more than 1 MiB on each of 4 ranks
SCRIPT = "image.SetExtent(piece)\nadd(image, distance(piece) + 0.05 * np.sin(points(piece)[0]))\n"
ORGANIZATIONS = ["Replicated", "Object based", "Page based"]
several = get_ranks() > 1
view = create_view()
view.UseFXAA = 0


def check_report(display, organization):
    rows = get_rows(display)
    check(len(rows) == get_ranks(), "every rank reports")
    check(all(row["Organization"] == organization.lower() for row in rows), f"it is {organization}")
    check(all(organization.lower() in row["Explanation"] for row in rows), rows[0]["Explanation"])
    for row in rows:
        check(row["Accesses"] == row["Hits"] + row["Misses"], "accesses are hits or misses")
        check(row["Joins"] <= row["Misses"], "a join is a miss")
        check(len(row["Workers"]) == row["Threads"], "every thread reports")
        for key in ("Accesses", "Hits", "Misses", "Joins"):
            check(sum(worker[key] for worker in row["Workers"]) == row[key], f"the threads' {key}")
        check(row["BytesCached"] <= row["CacheCapacity"], "the cache keeps within its capacity")
        check(row["BytesOfTables"] > 0, "there are tables")
        held = (row["BytesResident"] + row["BytesCopied"] + row["BytesOfTables"]
                + row["CacheCapacity"])
        check(held <= row["MemoryBudget"], "and all of it within the memory")
    check(sum(row["BytesSent"] for row in rows) == sum(row["BytesReceived"] for row in rows),
          "what is sent is received")
    return rows


# What Automatic chose.
source = image_source(SCRIPT, EXTENT)
log = os.path.join(OUTPUT, f"Memory{get_ranks()}.log")
vtkLogger.LogToFile(log, vtkLogger.TRUNCATE, vtkLogger.VERBOSITY_INFO)
with Messages() as messages:
    display = show(source, view, [0.7], "f")
    place_camera(view)
    picture = render(view, "Automatic")
    render(view)
vtkLogger.EndLogToFile(log)
check(not any(word in messages.text for word in ("DSM Ray Tracer", "ERR", "arning")),
      "what fits the memory is not reported: " + messages.text)
check(get_covered(picture).any(), "the surface is there")
with open(log, encoding="utf-8") as text:
    said = text.read()
check(said.count("memory organization is replicated: all data take") == (1 if several else 0),
      "what was chosen is logged once: " + said)

check_report(display, "Replicated")
there = list(view.CameraPosition)
view.CameraPosition = [value + 3.0 for value in there]
view.SMProxy.InteractiveRender()
check(sum(row["Accesses"] for row in get_rows(display)) > 0, "a picture that nothing is known of reads bricks")
view.CameraPosition = there

# Every organization, with and without the memory of the others on the host.
for sharing in (0, 1):
    display.DSMHostSharing = sharing
    for organization in ORGANIZATIONS:
        display.DSMMemoryOrganization = organization
        with Messages() as messages:
            again = render(view)
        check(messages.text.strip() == "", "nothing is reported: " + messages.text)
        check_equal(again, picture, f"{organization}, sharing {sharing}: same picture", tolerance=0)
        rows = check_report(display, organization)
        in_place = sharing and len({row["Host"] for row in rows}) == 1
        fetches = several and organization != "Replicated" and not (
            in_place and organization == "Object based")
        # The last frame may find all that the ones before it have fetched.
        check(any(row["BytesCached"] > 0 for row in rows) == fetches, f"bricks are fetched: {fetches}")
        check(any(row["BytesCopied"] > 0 for row in rows) == (
            several and organization == "Replicated" and not in_place), "and copied when replicated")

# A cache of very few bricks.
display.DSMHostSharing = 0
display.DSMCacheSize = 1
for organization in ORGANIZATIONS[1:]:
    display.DSMMemoryOrganization = organization
    for position in ((0.6, 0.5, 1.0), (-1.0, 0.2, 0.3), (0.6, 0.5, 1.0)):
        place_camera(view, position)
        last = render(view)
    check_equal(last, picture, f"{organization} with a small cache: same picture", tolerance=0)
    check(all(row["CacheCapacity"] <= 1 << 20 for row in get_rows(display)), "as small as asked for")

# Too little memory: refused with numbers, and the session goes on.
display.DSMCacheSize = 256
for organization, remedy in (("Object based", "ranks with as much memory"),
                             ("Page based", "ranks with as much memory"),
                             ("Replicated", "object based memory organization")):
    display.DSMMemoryOrganization = "Automatic"
    display.DSMMemory = 0
    check_equal(render(view), picture, "the surface is there", tolerance=0)
    display.DSMMemoryOrganization = organization
    display.DSMMemory = 1
    with Messages() as messages:
        refused = render(view)
        render(view)
    text = messages.text
    check(not get_covered(refused).any(), f"{organization}: nothing is drawn")
    check("DSMMemory" in text and "bytes" in text and remedy in text, "it says why: " + text)
    check(text.count("Raise the memory per rank") == 1, "once")
    display.DSMMemory = 64
    with Messages() as messages:
        again = render(view)
    check_equal(again, picture, f"{organization} with enough memory", tolerance=0)
    check(messages.text.strip() == "", "nothing is reported: " + messages.text)

# Two views share one memory: what one asks for is done for both.
second = create_view(200, 160)
second.UseFXAA = 0
other = show(source, second, [0.7], "f")
place_camera(second)
display.DSMMemoryOrganization = "Automatic"
references = []
for each in (view, second):  # the views of a layout may have changed their sizes
    render(each)
    references.append(render(each))
for organization in ("Page based", "Object based", "Automatic", "Page based"):
    display.DSMMemoryOrganization = organization
    for each, reference in zip((view, second) * 2, references * 2):
        check_equal(render(each), reference, f"{organization} in both views", tolerance=0)
    expected = "Replicated" if organization == "Automatic" else organization
    for each in (display, other):
        check(get_rows(each)[0]["Organization"] == expected.lower(), "both say so")

# What is set counts at once, though the other view has not been rendered since.
changes = {"DSMMemoryOrganization": ("Page based", "Object based"), "DSMThreads": (3, 1), "DSMCacheSize": (8, 2),
           "DSMMemory": (96, 48), "DSMHostSharing": (0, 1)}
for each in (view, second):
    render(each)
for name, (before, after) in changes.items():
    setattr(display, name, before)
    for each in (view, second):
        render(each)
    for each, shown, reference in ((view, display, references[0]), (second, other, references[1])):
        setattr(display, name, before)
        render(each)
        setattr(display, name, after)
        check_equal(render(each), reference, f"{name} {after}: same picture", tolerance=0)
        row = get_rows(shown)[0]
        said = {"DSMMemoryOrganization": ("Organization", "object based"), "DSMThreads": ("Threads", 1),
                "DSMCacheSize": ("CacheCapacity", 2 << 20), "DSMMemory": ("MemoryBudget", 48 << 20)}
        if name in said and (several or name != "DSMCacheSize"):
            key, value = said[name]
            check(row[key] == value, f"{name}: {key} is {row[key]}, with one view rendered")
display.DSMThreads = 0
display.DSMCacheSize = 256
display.DSMMemoryOrganization = "Automatic"
display.DSMMemory = 0
for each, reference in zip((view, second), references):
    check_equal(render(each), reference, "as it was", tolerance=0)

# Too little memory for both, and enough again; a failure that stays is said again.
display.DSMMemory = 1
with Messages() as messages:
    for each in (view, second):
        check(not get_covered(render(each)).any(), "too little memory for both views")
check("Raise the memory per rank" in messages.text, "it says why: " + messages.text)
with Messages() as messages:
    render(second)
check(messages.text.strip() == "", "but once: " + messages.text)
display.DSMMemoryOrganization = "Object based"
with Messages() as messages:
    render(second)
check("Raise the memory per rank" in messages.text, "a change that does not help is told: " + messages.text)
display.DSMMemoryOrganization = "Automatic"
display.DSMMemory = 0
with Messages() as messages:
    for each, reference in zip((second, second, view), references[::-1][:1] * 2 + references[:1]):
        check_equal(render(each), reference, "enough again, whichever view is rendered", tolerance=0)
check("ERROR" not in messages.text, "and nothing is reported: " + messages.text)
simple.Delete(source)
render(view)
