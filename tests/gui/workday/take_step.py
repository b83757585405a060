# SPDX-License-Identifier: BSD-3-Clause
"""Within ParaView, as macros: do() is what a step's function does, look() notes what the step has brought about: the
pictures of all views as they are, without another render, the state, what the application has said, and what the
ranks of a server hold. DSM_WORKDAY is the folder for all of this, `said` in it what the application writes."""

import json
import os
import time
import traceback

from paraview import simple
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

from server_of_ranks import get_heap, holds_blocks
from started import find_descendants, get_memory
from steps import get_steps

FOLDER = os.environ["DSM_WORKDAY"]
KIND = os.environ["DSM_WORKDAY_KIND"]
PARENT = int(os.environ.get("DSM_WORKDAY_PARENT", "0"))
TODAY = get_steps(KIND, tuple(map(int, os.environ["DSM_WORKDAY_VERSION"].split("."))))


class Progress:
    taken = 0
    looks = 0  # at the current step
    noted = False
    heard = 0


def note(entry):
    with open(os.path.join(FOLDER, "notes.jsonl"), "a", encoding="utf-8") as notes:
        notes.write(json.dumps(entry) + "\n")


def fail():
    note({"step": TODAY[Progress.taken].name, "failure": traceback.format_exc()})
    os._exit(1)


def do():
    try:
        TODAY[Progress.taken].do(simple)
    except BaseException:
        fail()


def has_all_samples():
    for view in simple.GetRenderViews():
        for display in view.Representations:
            if display.GetProperty("DSMSamples") and display.Visibility:
                display.SMProxy.UpdatePropertyInformation()
                samples, wanted = display.GetPropertyValue("DSMSamples")
                if samples < wanted:
                    return False
    return True


def save_picture(view, name):
    image = vtkWindowToImageFilter()
    image.SetInput(view.GetRenderWindow())
    image.ShouldRerenderOff()
    image.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetInputConnection(image.GetOutputPort())
    writer.SetFileName(os.path.join(FOLDER, name))
    writer.Write()


def hear():
    with open(os.path.join(FOLDER, "said"), encoding="utf-8", errors="replace") as said:
        said.seek(Progress.heard)
        text = said.read()
        Progress.heard = said.tell()
    return text


def describe(step, number):
    entry = {"step": step.name, "number": number, "time": time.time(), "pictures": [], "sizes": []}
    if step.look != "none":
        for index, view in enumerate(simple.GetRenderViews()):
            entry["pictures"].append(f"{number:02}.{index}.png")
            entry["sizes"].append(list(view.GetRenderWindow().GetSize()))
            save_picture(view, entry["pictures"][-1])
    if step.look == "compare":
        simple.SaveState(os.path.join(FOLDER, f"{number:02}.pvsm"))
    entry["said"] = hear()
    ranks = find_descendants(PARENT, "pvserver") if PARENT else []
    entry["memory"] = [get_memory(rank) for rank in ranks]
    entry["heap"] = [get_heap(rank, os.environ["DSM_WORKDAY_HEAPS"]) for rank in ranks]
    entry["blocks"] = [holds_blocks(rank) for rank in ranks]
    return entry


def look():
    """The player looks as often as the step says; what is noted is the first look at all samples, where there is
    anything to see, or the last."""
    step = TODAY[Progress.taken]
    try:
        Progress.looks += 1
        if not Progress.noted and (Progress.looks == step.looks or (step.look != "none" and has_all_samples())):
            note(describe(step, step.number))
            Progress.noted = True
        elif not Progress.noted:
            time.sleep(0.1)
    except BaseException:
        fail()
    if Progress.looks == step.looks:
        Progress.taken += 1
        Progress.looks = 0
        Progress.noted = False
