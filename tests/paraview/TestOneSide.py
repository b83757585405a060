# SPDX-License-Identifier: BSD-3-Clause
"""A plugin that only a server or only its client has loaded changes nothing; once both have it, there is a picture.
Called as TestOneSide.py PLUGIN OUTPUT PORT FIRST, where FIRST is the side that loads it first: server or client."""

from dsm_testing import *

PORT, FIRST = int(sys.argv[3]), sys.argv[4]


def show_all(view):
    """What each dataset may be shown as."""
    offered = []
    for source in (simple.Wavelet(), simple.Sphere()):
        display = simple.Show(source, view)
        offered.append(list(display.GetProperty("Representation").Available))
    simple.Render(view)
    return offered


simple.Connect("127.0.0.1", PORT)
view = create_view()
for remote in (FIRST == "server", FIRST != "server"):
    with Messages() as messages:
        simple.LoadPlugin(PLUGIN, remote=remote, ns=vars(simple))
        offered = show_all(view)
        said = messages.text
    print(said, flush=True)
    both = remote != (FIRST == "server")
    check(said.strip() == "", "nothing is said")
    check(all("Surface" in names for names in offered), "ParaView's own representations are offered")
    check(all((REPRESENTATION in names) == both for names in offered), f"ours, too: {both}")
simple.HideAll(view)
display = simple.Show(simple.Wavelet(), view)
display.Representation = REPRESENTATION
# Python made the display's class before the plugin was there, and keeps it.
values = display.SMProxy.GetProperty("DSMIsoValues")
values.SetElement(0, 130.0)
display.SMProxy.UpdateVTKObjects()
place_camera(view)
check(get_covered(render(view)).any(), "and there is a picture")
simple.Disconnect()
