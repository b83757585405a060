# SPDX-License-Identifier: BSD-3-Clause
"""A client whose plugin has the version VERSION, and a server with a plugin of another: the user is told,
once, and goes on. Called as TestVersions.py PLUGIN OUTPUT PORT VERSION SERVERPLUGIN."""

from dsm_testing import *

PORT, VERSION, SERVER_PLUGIN = int(sys.argv[3]), sys.argv[4], sys.argv[5]
simple.Connect("127.0.0.1", PORT)
simple.LoadPlugin(SERVER_PLUGIN, remote=True, ns=vars(simple))
simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))
view = create_view()
with Messages() as messages:
    source = simple.Wavelet()
    display = show(source, view, [130.0, 200.0])
    place_camera(view)
    pictures = render(view)
    simple.Show(simple.Sphere(), view).Representation = REPRESENTATION
    render(view)
    said = messages.text
print(said, flush=True)
check(said.count("Load the same version on both sides") == 1, "it is said once")
check(f"has version {VERSION} on this client" in said and "version 9.9" in said and "on the server" in said,
      "with both versions")
check(get_covered(pictures).any(), "and there is a picture")
simple.Disconnect()
