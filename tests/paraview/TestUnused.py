# SPDX-License-Identifier: BSD-3-Clause
"""What the plugin does for those who do not use it: nothing. A view has nothing of ours while no dataset is shown as
ours, whatever else it shows; its frames are as fast, and the ranks hold no more, than without the plugin."""

import gc
import glob
import statistics
import time

from dsm_testing import *

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import started

ROUNDS = 10
LARGEST_RATIO = 1.15  # of processor times to draw; those of the same thing twice differ as much on a busy machine
LARGEST_GROWTH = 5.5 * 1024  # KiB
# Rank 0 is the client, too: its displays of surfaces and grids have the properties of volumes and slices.
LARGEST_OF_CLIENT = 16.0 * 1024


def list_ours(view):
    """The classes of what is ours among the props that the renderer draws."""
    props = view.GetClientSideObject().GetRenderer().GetViewProps()
    shown = [props.GetItemAsObject(index) for index in range(props.GetNumberOfItems())]
    names = [prop.GetClassName() for prop in shown]
    names += [prop.GetMapper().GetClassName() for prop in shown
              if hasattr(prop, "GetMapper") and prop.GetMapper() and prop.GetVisibility()]
    return [name for name in names if "DSM" in name]


def return_memory():
    """What ranks do not need goes back to the system. Else they keep some MiB now and then, whatever is loaded."""
    gc.collect()
    source = simple.ProgrammableSource(Script="import ctypes; ctypes.CDLL(None).malloc_trim(0)")
    source.UpdatePipeline()
    simple.Delete(source)


def get_memory(view):
    """The least after some frames: after one now and then OpenGL keeps 14 MiB until the next, whatever is loaded."""
    held = []
    for _ in range(5):
        draw_still(view)
        return_memory()
        held.append(get_memory_now())
    return numpy.min(held, axis=0)


def get_memory_now():
    """What each rank holds, in KiB."""
    return numpy.array([started.get_memory(rank) for rank in started.find_descendants(os.getppid(), "pvbatch")])


def load_another_plugin():
    """One of ParaView's own: any makes it read all its definitions again. Where there is none, ours counts for that."""
    with open("/proc/self/maps", encoding="utf-8") as text:
        library = next(line.split()[-1] for line in text if "libvtkRemotingViews" in line)
    name = "StreamLinesRepresentation"
    for found in glob.glob(os.path.join(os.path.dirname(library), "paraview-*", "plugins", name, name + ".so")):
        simple.LoadPlugin(found, remote=False, ns=vars(simple))


def show_others():
    """A view of a Surface and a Contour, which has been drawn."""
    view = create_view()
    wavelet = simple.Wavelet(WholeExtent=[-20, 20, -20, 20, -20, 20])
    contour = simple.Contour(Input=wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[130.0, 200.0])
    simple.Show(contour, view).Representation = "Surface"
    simple.Show(simple.Sphere(Radius=30.0, ThetaResolution=100, PhiResolution=100), view).Opacity = 1.0
    place_camera(view)
    draw_still(view)
    draw_moving(view)
    return view


def draw_still(view):
    view.SMProxy.StillRender()


def draw_moving(view):
    view.GetActiveCamera().Azimuth(3.0)
    view.SMProxy.InteractiveRender()


def compare_times(draw, view, other):
    """How much more processor time it takes to draw a view than another, in turn."""
    taken = {view: [], other: []}
    for number in range(2 * ROUNDS):
        # Each comes as often after the other as after itself.
        drawn = (view, other, other, view)[number % 4]
        start = time.process_time()
        draw(drawn)
        taken[drawn].append(time.process_time() - start)
    # The quicker half: caches are cold now and then.
    quick = {drawn: statistics.mean(sorted(times)[: len(times) // 2]) for drawn, times in taken.items()}
    return quick[view] / quick[other], 1000 * quick[view]


held = []
views = []
for load in (lambda: None, load_another_plugin, lambda: None, load_plugin, lambda: None):
    load()
    views.append(show_others())
    held.append(get_memory(views[-1]))
without, view = views[2], views[4]
check(held[0].size == get_ranks(), f"{get_ranks()} ranks are seen: {held[0]} KiB")
# What loading takes, and two views; less what that took before. Both, as freed memory comes back now or then.
growth = (held[4] - held[2]) - (held[2] - held[0])
check(growth[1:].max(initial=0) < LARGEST_GROWTH and growth[0] < LARGEST_OF_CLIENT,
      f"with the plugin, the ranks hold {growth} KiB more")
check(list_ours(view) == [], f"a view of surfaces has nothing of ours: {list_ours(view)}")
for draw in (draw_still, draw_moving):
    for _ in range(3):  # until once it was left alone
        ratio, milliseconds = compare_times(draw, view, without)
        if ratio < LARGEST_RATIO:
            break
    check(ratio < LARGEST_RATIO,
          f"{draw.__name__}: a frame of {milliseconds:.2f} ms takes {ratio:.3f} of what it takes without the plugin")

sources = [simple.Wavelet(), simple.Sphere()]
displays = [simple.Show(source, view) for source in sources]
for display in displays:
    display.Representation = REPRESENTATION
simple.Render(view)
check("vtkDSMFrameProp" in list_ours(view), f"one of ours has: {list_ours(view)}")
for display in displays:
    display.Visibility = 0
simple.Render(view)
for display in displays:
    display.Representation = "Surface"
simple.Render(view)
