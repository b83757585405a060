# SPDX-License-Identifier: BSD-3-Clause
"""A server of several clients, at the port that is given: the one that leads takes the isovalue that the data
suggest."""

from dsm_testing import *

simple.Connect("127.0.0.1", int(sys.argv[3]))
load_plugin()
view = create_view()
source = simple.Wavelet()
display = show_traced(source, view)
place_camera(view)
picture = render(view)
check(get_covered(picture).any(), "the surface is shown at what the data suggest")
check(display.DSMIsoValueAutomatic == 1, "at an automatic isovalue")
check(display.DSMIsoValue != display.GetPropertyValue("DSMSuggestedIsoValue"),
      "a client that only looks on sets nothing")

clients = servermanager.ActiveConnection.Session.GetCollaborationManager()
clients.UpdateUserInformations()
clients.PromoteToMaster(clients.GetUserId())
check_equal(render(view), picture, "the picture stays when the client leads", 0)
value = display.DSMIsoValue
check(value == display.GetPropertyValue("DSMSuggestedIsoValue"), f"its panel shows the isovalue: {value}")
