# SPDX-License-Identifier: BSD-3-Clause
"""A client that draws on a server. Called as TestClient.py PLUGIN OUTPUT PORT RANKS, where OUTPUT
holds the pictures of TestViews.py."""

from dsm_testing import *

PORT, RANKS = sys.argv[3], int(sys.argv[4])
connect(PORT)
load_plugin()
view = create_view()
source = simple.Wavelet()
display = show(source, view, [130.0, 200.0])
place_camera(view)
picture = render(view)
reference = numpy.load(os.path.join(OUTPUT, "FirstView.npy"))
check_equal(picture, reference, "the server's picture is that of one rank")

rows = get_rows(display)
check(len(rows) == RANKS, "every rank of the server reports to the client")
check(sum(row["Tiles"] for row in rows) > 0, "and traced")
display.DSMSamplesPerPixel = 3
simple.Render(view)
display.SMProxy.UpdatePropertyInformation()
check(list(display.GetPropertyValue("DSMSamples")) == [3, 3],
      "where nobody waits for more, a render takes all samples at once")
display.DSMSamplesPerPixel = 1

# Remote rendering of a reduced image, as while interacting.
view.RemoteRenderThreshold = 0.0
view.LODThreshold = 0.0
view.ImageReductionFactor = 4
view.SMProxy.InteractiveRender()
view.StillRenderImageReductionFactor = 2
reduced = render(view)
wrong = (get_covered(reduced) != get_covered(picture)).mean()
check(wrong < 0.02, f"a reduced image shows the same ({100 * wrong:.2f} %)")
view.StillRenderImageReductionFactor = 1
check_equal(render(view), picture, "and the full one again")

with Messages():
    display.DSMIsoArray = ["POINTS", "nonsense"]
    check(not get_covered(render(view)).any(), "a wrong array shows nothing")
display.DSMIsoArray = ["POINTS", "RTData"]
check_equal(render(view), picture, "and the right one the surface")

outline = show_surface(simple.Outline(source), view)
outline.Opacity = 0.5
check(get_covered(render(view)).any(), "with something translucent")
simple.Delete(outline)
simple.Hide(source, view)
render(view)

# A mesh, which never leaves the server.
ball = simple.Sphere(ThetaResolution=64, PhiResolution=48)
mesh = simple.Show(ball, view)
mesh.Representation = REPRESENTATION
simple.ColorBy(mesh, ("POINTS", "Normals", "X"))
place_camera(view)
traced = render(view)
rows = get_rows(mesh)
check(len(rows) == RANKS, "every rank reports on the mesh")
mesh.Representation = "Surface"
check_same_surface(traced, render(view), "a mesh on the server")

# Translucent, with something else behind and in it.
cone = simple.Cone(Height=0.6, Radius=0.2, Resolution=20)
inner = show_surface(cone, view)
inner.DiffuseColor = inner.AmbientColor = [0.2, 1.0, 0.3]
mesh.ColorArrayName = [None, ""]
mesh.Opacity = 0.5
view.UseFXAA = 0
pictures = []
for name in (REPRESENTATION, "Surface"):
    mesh.Representation = name
    pictures.append(render(view))
difference = abs(pictures[0] - pictures[1])
check((difference > 30).any(axis=2).mean() < 0.002 and difference.mean() < 0.3,
      f"a translucent mesh on the server differs by {difference.mean():.2f}")
simple.Delete(cone)

# Selected.
mesh.Opacity = 1.0
selections = []
for name in (REPRESENTATION, "Surface"):
    mesh.Representation = name
    render(view)
    simple.SelectSurfaceCells(Rectangle=[140, 100, 160, 140], View=view)
    extract = simple.ExtractSelection(Input=ball)
    extract.UpdatePipeline()
    selections.append(extract.GetDataInformation().GetNumberOfCells())
    simple.Delete(extract)
    simple.ClearSelection(ball)
check(selections[0] > 3 and selections[0] == selections[1],
      f"{selections} cells are selected, traced and as Surface")
simple.Delete(ball)
simple.Delete(source)
render(view)
