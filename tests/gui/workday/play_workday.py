#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Has ParaView's test player take the steps of steps.py in the real application, and looks at each: whether the
application said anything, whether the picture is what ParaView draws with representations of its own, or that of an
earlier step, and whether the ranks of a server give their memory back. Called as
    play_workday.py --plugin FILE --output FOLDER --paraview PROGRAM --pvbatch PROGRAM
        [--references FOLDER] [--heap-notes FILE --server COMMAND...]
With a server, the application is connected to it, and its ranks load the library that notes their heaps. ParaView's
own pictures may be those of an earlier run."""

import argparse
import json
import os
import shutil
import subprocess
import sys
from xml.sax.saxutils import quoteattr

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

HERE = os.path.dirname(os.path.abspath(__file__))
SUPPORT = os.path.join(os.path.dirname(os.path.dirname(HERE)), "support")
sys.path.insert(1, os.path.dirname(HERE))
sys.path.insert(2, SUPPORT)
import file_dialog
import server_of_ranks
from started import ended_with_this
from steps import get_steps, menu

PATIENCE = 480.0  # seconds, less than that of the tests, which end no server

# A pixel is another where a channel differs by more; so may a share of all be, along edges, and where rays
# and triangles see a part that is thinner than a pixel. The mean is that of the difference over what is shown.
LARGE_DIFFERENCE = 40
LARGEST_SHARE = 0.006
LARGEST_MEAN = 7.0
# Of what the ranks of a server have in use of their heaps when all is deleted after a state was loaded, what they may
# have more in use when all is deleted again. The first state costs memory for good: ParaView's own, also without the
# plugin, as does each later one, with 0.16 MiB.
HEAP_KEPT = 0.02
# Of what they hold of the system then, which has gaps.
MEMORY_KEPT = 0.2
# And of what they took since the plugin was loaded, when all was deleted for the first time.
MEMORY_AFTER = 0.45
START, BEFORE, FIRST = "Load Plugin", "Save State as Python", "Delete All"
DELETED = ("Delete All once more", "Delete All a third time", "Delete All at last")
# What the application says of itself.
HARMLESS = ("QStandardPaths: ", "QPixmap::scaled: ", "Process started", "Playing: ", "debug: ", "Success")


def check(condition, what):
    if not condition:
        raise AssertionError(what)
    print("ok:", what, flush=True)


def get_arguments():
    parser = argparse.ArgumentParser()
    for name in ("plugin", "output", "paraview", "pvbatch"):
        parser.add_argument("--" + name, required=True)
    for name in ("references", "heap-notes"):
        parser.add_argument("--" + name)
    parser.add_argument("--server", nargs=argparse.REMAINDER)
    return parser.parse_args()


def check_memory(notes):
    """What is deleted goes back to the system, and nothing more stays each time."""
    for name in (FIRST, *DELETED):
        check(not any(notes[name]["blocks"]), f"{name}: no rank holds blocks")
    for start, before, after in zip(*(notes[name]["memory"] for name in (START, BEFORE, FIRST))):
        check(after - start < MEMORY_AFTER * (before - start),
              f"{FIRST}: {after} KiB of {before} are left, beside {start} at first")
    for what, kept in (("heap", HEAP_KEPT), ("memory", MEMORY_KEPT)):
        first, *later = (notes[name][what] for name in DELETED)
        for name, kibibytes in zip(DELETED[1:], later):
            check(all(now < (1.0 + kept) * then for now, then in zip(kibibytes, first)),
                  f"{name}: {kibibytes} KiB of {what} are left, {first} were")


class Workday:
    def __init__(self, arguments):
        self.arguments = arguments
        self.output = os.path.abspath(arguments.output)
        self.references = os.path.abspath(arguments.references or arguments.output)
        self.kind = "server" if arguments.server else "alone"
        self.version = file_dialog.get_version(arguments.paraview)
        self.steps = get_steps(self.kind, self.version)

    def write_events(self, path):
        replaced = {"@PLUGIN@": self.arguments.plugin, "@OUTPUT@": self.output,
                    "@FILE_DIALOG@": file_dialog.get_name(self.arguments.paraview)}
        with open(path, "w", encoding="utf-8") as text:
            text.write('<?xml version="1.0" ?>\n<pqevents>\n')
            for step in self.steps:
                events = list(step.events)
                if step.do:
                    events += menu("menu_Macros", "Do")
                for event in events + menu("menu_Macros", "Look") * step.looks:
                    values = []
                    for value in event:
                        for name, other in replaced.items():
                            value = value.replace(name, other)
                        values.append(quoteattr(value))
                    text.write("  <pqevent object=%s command=%s arguments=%s />\n" % tuple(values))
            text.write("</pqevents>\n")

    def write_macros(self, folder):
        os.makedirs(folder)
        for name in ("Do", "Look"):
            with open(os.path.join(folder, name + ".py"), "w", encoding="utf-8") as text:
                text.write(f"import sys\nsys.path[:0] = {[HERE, SUPPORT]!r}\nimport take_step\n"
                           f"take_step.{name.lower()}()\n")

    def play(self, options, environment):
        shutil.rmtree(self.output, ignore_errors=True)
        os.makedirs(self.output)
        events = os.path.join(self.output, "events.xml")
        self.write_events(events)
        settings = os.path.join(self.output, "settings")
        macros = os.path.join(self.output, "macros")
        self.write_macros(macros)
        environment = dict(os.environ, XDG_CONFIG_HOME=settings, DSM_WORKDAY=self.output,
                           DSM_WORKDAY_KIND=self.kind, DSM_WORKDAY_PLUGIN=self.arguments.plugin,
                           DSM_WORKDAY_VERSION=".".join(map(str, self.version)), PV_MACRO_PATH=macros,
                           DASHBOARD_TEST_FROM_CTEST="1", PYTHONDONTWRITEBYTECODE="1", **environment)
        command = [self.arguments.paraview, "--dr", *options, f"--test-directory={self.output}",
                   f"--test-script={events}", "--exit"]
        with open(os.path.join(self.output, "said"), "w", encoding="utf-8") as said:
            return subprocess.call(command, stdout=said, stderr=said, env=environment, timeout=PATIENCE)

    def read_notes(self):
        with open(os.path.join(self.output, "notes.jsonl"), encoding="utf-8") as text:
            return [json.loads(line) for line in text]

    def read_picture(self, name):
        reader = vtkPNGReader()
        reader.SetFileName(os.path.join(self.output, name))
        reader.Update()
        width, height, _ = reader.GetOutput().GetDimensions()
        values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
        return values.reshape(height, width, -1)[:, :, :3].astype(int)

    def get_reference(self, picture):
        return os.path.join(self.references, picture.replace(".png", ".reference.png"))

    def get_difference(self, name, other):
        """The share of pixels that are others, and the mean difference of those that show something."""
        first, second = self.read_picture(name), self.read_picture(other)
        if first.shape != second.shape:
            return 1.0, 255.0
        difference = abs(first - second).max(axis=2)
        shown = (abs(first - first[0, 0]).max(axis=2) > 2) | (abs(second - second[0, 0]).max(axis=2) > 2)
        return (difference > LARGE_DIFFERENCE).mean(), difference[shown].mean() if shown.any() else 0.0

    def check_same(self, name, other, what):
        share, mean = self.get_difference(name, other)
        check(share <= LARGEST_SHARE and mean <= LARGEST_MEAN,
              f"{what}: {100 * share:.2f} % of the pixels are others, the mean difference is {mean:.2f}")

    def check_comparison(self, notes):
        """That a wrong picture is found to be wrong: another isovalue, that of a step before, is not like it."""
        names = [entry["step"] for entry in notes]
        for name in ("an isovalue, typed", "an isovalue, by the slider", "without the box's widget", "Choose Preset"):
            number = names.index(name)
            before = next(self.steps[index] for index in range(number - 1, 0, -1)
                          if self.steps[index].look == "compare")
            share, mean = self.get_difference(
                notes[number]["pictures"][0], self.get_reference(f"{before.number:02}.0.png")
            )
            check(share > LARGEST_SHARE and mean > LARGEST_MEAN,
                  f"without '{name}', {100 * share:.2f} % of the pixels were others, the mean difference {mean:.2f}")

    def check_step(self, step, entry, earlier):
        said = [line for line in entry["said"].splitlines() if line.strip() and not line.startswith(HARMLESS)]
        check(not said, f"{entry['number']:02} {step.name}: nothing is said {said}")
        pictures = [self.read_picture(picture) for picture in entry["pictures"]]
        check(not pictures or any((pixels != pixels[0, 0]).any() for pixels in pictures), "and something is shown")
        if step.look == "compare":
            for picture in entry["pictures"]:
                self.check_same(picture, self.get_reference(picture), f"{picture}, {step.name}")
        elif step.look.startswith("like "):
            like = earlier[step.look[len("like "):]]
            for picture, other in zip(entry["pictures"], like["pictures"]):
                self.check_same(picture, other, f"{picture} is like {other}")
                check(len(entry["pictures"]) == len(like["pictures"]), "and there are as many views")


def main():
    arguments = get_arguments()
    day = Workday(arguments)
    if arguments.server:
        with server_of_ranks.ServerOfRanks(arguments.server, arguments.heap_notes) as server:
            code = day.play([f"--server-url=cs://127.0.0.1:{server.port}"],
                            {"DSM_WORKDAY_PORT": str(server.port), "DSM_WORKDAY_PARENT": str(os.getpid()),
                             "DSM_WORKDAY_HEAPS": server.heaps.name})
    else:
        code = day.play([], {})
    notes = day.read_notes()
    for entry in notes:
        if "failure" in entry:
            raise AssertionError(f"{entry['step']}: {entry['failure']}")
    with open(os.path.join(day.output, "said"), encoding="utf-8") as said:
        left = said.read()[-3000:] if code else ""
        check(code == 0 and len(notes) == len(day.steps), "all steps are taken " + left)
    if not arguments.references:
        script = os.path.join(HERE, "draw_references.py")
        subprocess.check_call([arguments.pvbatch, script, arguments.plugin, day.output])
    earlier = {}
    for step, entry in zip(day.steps, notes):
        day.check_step(step, entry, earlier)
        earlier[step.name] = entry
    day.check_comparison(notes)
    if arguments.server:
        check_memory(earlier)


with ended_with_this():
    main()
