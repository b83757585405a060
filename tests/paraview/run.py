# SPDX-License-Identifier: BSD-3-Clause
"""Runs test scripts in pvbatch or pvpython:

    pvbatch run.py TestX.py PLUGIN OUTPUT ...       one script, by hand
    pvbatch run.py --list LIST REPORT               all scripts of a list, in turn; run_scripts.py makes both files

Each line of LIST has a script and its arguments, separated by tabs; @PORT@ stands for that of the server. Each line of
REPORT has what became of a script (begun, passed, failed or skipped), its time in seconds, and why it failed.

A script runs in a namespace of its own, because ParaView executes programmable sources in that of the main script,
where they replace names like `max`. Between two scripts the session is reset, which deletes sources, views and
settings."""

import gc
import os
import runpy
import sys
import time
import traceback

folder = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path.insert(0, folder)
SKIPPED = 77  # CTest's SKIP_RETURN_CODE


def run(arguments):
    """Runs a script as if it had been called with these arguments."""
    sys.argv = arguments
    runpy.run_path(os.path.join(folder, arguments[0]))


def reset_memory(simple):
    """Sets what a session's displays share back to its defaults: a reset leaves the session itself, which keeps
    them."""
    view = simple.CreateRenderView()
    display = simple.Show(simple.Sphere(), view)
    # They are linked to the settings page.
    hints = {name: display.SMProxy.GetProperty(name).GetHints() for name in display.ListProperties() if "DSM" in name}
    names = [name for name, hint in hints.items() if hint and hint.FindNestedElementByName("PropertyLink")]
    if names:  # the plugin is loaded
        display.Representation = "DSM Ray Traced"
        for name in names:
            display.SMProxy.GetProperty(name).ResetToDefault()
        display.SMProxy.UpdateVTKObjects()


def reset_session(environment):
    """Leaves nothing of a script: no proxy, setting, active object or environment variable."""
    from paraview import servermanager, simple

    reset_memory(simple)
    gc.collect()  # proxies that only cycles of objects still refer to
    simple.ResetSession()
    # A session that begins with the plugin has a settings page, whose first look is not that of scripts without one.
    page = servermanager.ProxyManager().SMProxyManager.GetProxy("settings", "DSMRayTracerSettings")
    if page:
        servermanager.vtkSMPropertyHelper(page, "DSMLook").Set(0)
        page.UpdateVTKObjects()
    if hasattr(simple, "_funcs_internals"):
        simple._funcs_internals.first_render = True  # ParaView resets the camera before a script's first render
    os.environ.clear()
    os.environ.update(environment)


def run_isolated(arguments):
    """Returns what became of a script, and why it failed."""
    import dsm_testing

    dsm_testing.PLUGIN, dsm_testing.OUTPUT = arguments[1:3]
    environment = dict(os.environ)
    result = "passed", ""
    try:
        run(arguments)
    except SystemExit as exit_:
        if exit_.code == SKIPPED:
            result = "skipped", ""
        elif exit_.code not in (None, 0):
            result = "failed", f"exit code {exit_.code}"
    except BaseException as error:
        traceback.print_exc()
        result = "failed", f"{type(error).__name__}: {error}"
        error.__traceback__ = None  # its frames have the script's proxies
    reset_session(environment)
    return result


def run_list(scripts, report):
    sys.argv = scripts[0]  # dsm_testing takes its folders from there
    for arguments in scripts:
        name = os.path.basename(arguments[0])
        print(f"--- {name}", *arguments[1:], flush=True)
        print("begun", 0, "", sep="\t", file=report, flush=True)
        start = time.monotonic()
        result, reason = run_isolated(arguments)
        seconds = f"{time.monotonic() - start:.2f}"
        print(result, seconds, reason.replace("\n", " ").replace("\t", " "), sep="\t", file=report, flush=True)


if sys.argv[1] == "--list":
    with open(sys.argv[2], encoding="utf-8") as text:
        read = text.read().replace("@PORT@", os.environ.get("DSM_TEST_PORT", "@PORT@"))
    lines = [line.split("\t") for line in read.splitlines()]
    with open(sys.argv[3], "a", encoding="utf-8") as text:
        run_list(lines, text)
else:
    run(sys.argv[1:])
