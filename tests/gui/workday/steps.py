# SPDX-License-Identifier: BSD-3-Clause
"""The steps of a day's work with ParaView, in their order. A step is what a user does with menus, toolbars, panels
and the mouse (`events`, for ParaView's test player), and then what a script does within the application (the
function), where a mouse would add nothing.

look: "compare" where ParaView can draw the same with representations of its own; "like NAME" where the
picture must be that of another step; "shown" where there must be one; "none".
only: "alone" or "server", for steps that the other has not.
until: the version of ParaView from which on a step is left out, since the application itself fails."""

import gc
import os

from server_of_ranks import wait_until_listening

PANEL = ("pqClientMainWindow/propertiesDock/propertiesPanel/scrollArea/qt_scrollarea_viewport/"
         "scrollAreaWidgetContents/")
DISPLAY = PANEL + "DisplayFrame/ProxyPanel/"
MENUBAR = "pqClientMainWindow/menubar"
CONTROLS = "pqClientMainWindow/MainControlsToolbar"
REPRESENTATION = "pqClientMainWindow/representationToolbar/displayRepresentation/comboBox"
COLOR = "pqClientMainWindow/variableToolbar/displayColor/Variables"
APPLY = ("pqClientMainWindow/propertiesDock/propertiesPanel/Accept", "activate", "")
FRAME = ("pqClientMainWindow/centralwidget/MultiViewWidget/CoreWidget/qt_tabwidget_stackedwidget/"
         "MultiViewWidget1/Container/Frame.")
VIEW = FRAME + "0/CentralWidgetFrame/Viewport"
PLUGINS = "pqClientMainWindow/PluginManagerDialog"
TRACED = os.environ.get("DSM_WORKDAY_SHOWN", "DSM Ray Traced")

STEPS = []


class Step:
    def __init__(self, name, events, look, only, looks, until, do):
        self.number = len(STEPS)
        self.name, self.events, self.look, self.only, self.looks, self.do = name, events, look, only, looks, do
        self.until = until


def get_steps(kind, version):
    """Of a day alone or with a server, with a version of ParaView as file_dialog.get_version gives it."""
    steps = [step for step in STEPS if step.only in ("", kind) and not (step.until and version >= step.until)]
    for step in steps:
        if kind == "alone" and step.look == "none":
            step.looks = 1  # there are no ranks whose memory is looked at
    return steps


def step(name, events=(), look="compare", only="", looks=1, until=None):
    """looks: how often to look at most until all samples have come; where there is nothing to see, how often at all."""

    def add(do):
        STEPS.append(Step(name, list(events), look, only, looks, until, do))
        return do

    return add


def events_only(name, events, look="compare", only="", looks=1):
    step(name, events, look, only, looks)(None)


def menu(name, action, *submenus):
    path = "/".join((MENUBAR, name) + submenus)
    return [(MENUBAR, "activate", name), (path, "activate", action)]


def delete_all(name, only=""):
    """What a server's ranks then hold is noted two seconds later, when memory has gone back to the system."""
    events_only(name, menu("menu_Edit", "actionDelete_All"), look="none", only=only, looks=20)


def choose(name, action):
    """Of the sources or filters."""
    return menu(name, action, "Alphabetical")


def drag(x0, y0, x1, y1, button=1, view=VIEW):
    """In parts of the view's size."""
    middle = (0.5 * (x0 + x1), 0.5 * (y0 + y1))
    return [
        (view, "mousePress", f"({x0},{y0},{button},{button},0)"),
        (view, "mouseMove", f"({middle[0]},{middle[1]},{button},0,0)"),
        (view, "mouseMove", f"({x1},{y1},{button},0,0)"),
        (view, "mouseRelease", f"({x1},{y1},{button},0,0)"),
    ]


def show_as(name):
    return [(REPRESENTATION, "set_string", name)]


def get_display(simple):
    return simple.GetDisplayProperties()


def set_display(simple, **properties):
    display = get_display(simple)
    for name, value in properties.items():
        setattr(display, name, value)
    simple.Render()


def set_transform(simple, position, **properties):
    is_renamed = get_display(simple).SMProxy.GetProperty("Translation")  # since ParaView 5.13
    set_display(simple, **{"Translation" if is_renamed else "Position": position}, **properties)


# -- The plugin, a volume, its isosurface ---------------------------------------------------------------


@step("an empty view", look="none")
def prepare(simple):
    simple.GetLayout().SetSize(480, 400)
    view = simple.GetActiveView()
    view.OrientationAxesVisibility = 0
    if TRACED != "DSM Ray Traced":  # then the server is to draw, too
        simple.GetSettingsProxy("RenderViewSettings").RemoteRenderThreshold = 0.0
    simple.Render()


events_only("Load Plugin on the server", menu("menuTools", "actionManage_Plugins") + [
    (PLUGINS + "/splitter/remoteGroup/loadRemote", "activate", ""),
    (PLUGINS + "/@FILE_DIALOG@", "filesSelected", "@PLUGIN@"),
    (PLUGINS + "/buttonBox/1QPushButton0", "activate", ""),
], look="none", only="server")


@step("Load Plugin", menu("menuTools", "actionManage_Plugins") + [
    (PLUGINS + "/splitter/localGroup/loadLocal", "activate", ""),
    (PLUGINS + "/@FILE_DIALOG@", "filesSelected", "@PLUGIN@"),
    (PLUGINS + "/buttonBox/1QPushButton0", "activate", ""),
], look="none")
def choose_plain_look(simple):
    """Contour's; kept as the settings dialog keeps it, for Delete All reads all settings anew."""
    from paraview.modules.vtkRemotingServerManager import vtkSMSettings

    settings = simple.GetSettingsProxy("DSMRayTracerSettings").SMProxy
    settings.GetProperty("DSMLook").SetElement(0, 0)
    settings.UpdateVTKObjects()
    vtkSMSettings.GetInstance().SetProxySettings(settings)


events_only("Wavelet", choose("menuSources", "RTAnalyticSource"), look="none")
events_only("Apply", [APPLY])
events_only("DSM Ray Traced", show_as(TRACED))
events_only("an isovalue, typed", [
    (DISPLAY + "DSMIsoValue/DoubleRangeWidget/DoubleLineEdit", "set_string", "157.1"),
])
events_only("an isovalue, by the slider", [
    (DISPLAY + "DSMIsoValue/DoubleRangeWidget/Slider", "set_int", "40"),
])

# -- The camera -----------------------------------------------------------------------------------------
events_only("Rotate", drag(0.4, 0.5, 0.6, 0.65))
events_only("Zoom", drag(0.5, 0.5, 0.5, 0.6, button=2))
events_only("Set view direction to +X", [("pqClientMainWindow/cameraToolbar/actionPositiveX", "activate", "")])
events_only("Isometric view", [("pqClientMainWindow/cameraToolbar/actionIsometricView", "activate", "")])
events_only("Reset", [("pqClientMainWindow/cameraToolbar/actionResetCamera", "activate", "")])

# -- Colors and materials ------------------------------------------------------------------------------


@step("Color By the isosurface's own array")
def color_by_own(simple):
    simple.ColorBy(get_display(simple), ("POINTS", "RTData"))
    simple.Render()


events_only("Scalar bar off", [("pqClientMainWindow/variableToolbar/actionScalarBarVisibility", "activate", "")])
events_only("Solid Color", [(COLOR, "activated", "Solid Color")])


@step("a colour, shiny")
def paint(simple):
    set_display(simple, AmbientColor=[0.9, 0.6, 0.3], DiffuseColor=[0.9, 0.6, 0.3], Specular=0.6, SpecularPower=20.0)


@step("Opacity 0.5", look="shown")
def fade(simple):
    set_display(simple, Opacity=0.5)


@step("Opacity 1", look="like a colour, shiny")
def unfade(simple):
    set_display(simple, Opacity=1.0)


@step("several isovalues")
def add_isovalues(simple):
    set_display(simple, DSMIsoValues=[110.0, 200.0])


@step("one isovalue", look="like a colour, shiny")
def take_one_isovalue(simple):
    set_display(simple, DSMIsoValues=[])


# -- Light ----------------------------------------------------------------------------------------------


@step("4 samples of each pixel, which come by themselves", looks=10)
def take_samples(simple):
    set_display(simple, DSMSamplesPerPixel=4)


@step("Shadows and ambient occlusion", look="shown", looks=10)
def shade(simple):
    set_display(simple, DSMShadows=1, DSMAmbientOcclusionSamples=1)


@step("without", look="like a colour, shiny")
def unshade(simple):
    set_display(simple, DSMShadows=0, DSMAmbientOcclusionSamples=0, DSMSamplesPerPixel=1)


@step("Add Light, the light kit off")
def add_light(simple):
    view = simple.GetActiveView()
    light = simple.AddLight(view)
    light.Position = [30.0, 40.0, 60.0]
    view.UseLight = 0
    simple.Render()


@step("Remove Light", look="like a colour, shiny")
def remove_light(simple):
    view = simple.GetActiveView()
    simple.RemoveLight(view.AdditionalLights[0])
    view.UseLight = 1
    simple.Render()


# -- Parts and places -----------------------------------------------------------------------------------


@step("a clipping plane", look="shown")
def clip(simple):
    set_display(simple, DSMClip=1, DSMClipOrigin=[0.0, 0.0, 0.0], DSMClipNormal=[-1.0, -0.5, -0.3])


# The panel shows its widgets a moment after the property has changed; ParaView's own pictures have none.
@step("without the plane's widget")
def hide_plane(simple):
    simple.HideInteractiveWidgets(proxy=get_display(simple))
    simple.Render()


@step("a cropping box", look="shown")
def crop(simple):
    set_display(simple, DSMClip=0, DSMCropping=1, DSMCroppingBox=[-10.0, 4.0, -10.0, 10.0, -10.0, 6.0])


@step("without the box's widget")
def hide_box(simple):
    simple.HideInteractiveWidgets(proxy=get_display(simple))
    simple.Render()


@step("all of it", look="like a colour, shiny")
def uncrop(simple):
    set_display(simple, DSMCropping=0)


@step("moved, turned and stretched")
def place(simple):
    set_transform(simple, position=[3.0, 2.0, 0.0], Orientation=[0.0, 30.0, 20.0], Scale=[1.0, 1.3, 0.8])


@step("where it was", look="like a colour, shiny")
def replace(simple):
    set_transform(simple, position=[0.0, 0.0, 0.0], Orientation=[0.0, 0.0, 0.0], Scale=[1.0, 1.0, 1.0])


# -- Undo, and other representations --------------------------------------------------------------------
# Nothing is looked at between: since ParaView 5.13, what was done before a macro ran cannot be undone.
UNDO = show_as("Outline") + menu("menu_Edit", "actionEditUndo")
events_only("Outline and Undo", UNDO, look="like a colour, shiny")
events_only("Outline, Undo and Redo", UNDO + menu("menu_Edit", "actionEditRedo"))
events_only("Surface", show_as("Surface"))
events_only("DSM Ray Traced again", show_as(TRACED), look="like a colour, shiny")

# -- A second view --------------------------------------------------------------------------------------


@step("a second view of the same")
def split(simple):
    first = simple.GetActiveView()
    second = simple.CreateRenderView()
    second.OrientationAxesVisibility = 0
    simple.AssignViewToLayout(view=second, layout=simple.GetLayout(first), hint=0)
    display = simple.Show(simple.GetActiveSource(), second)
    display.Representation = TRACED
    display.DSMIsoValue = 120.0
    simple.ResetCamera(second)
    simple.RenderAllViews()


@step("linked cameras")
def link(simple):
    first, second = simple.GetRenderViews()
    simple.AddCameraLink(first, second, "both")
    simple.RenderAllViews()


events_only("Rotate both", drag(0.4, 0.5, 0.6, 0.6, view=VIEW.replace("Frame.0", "Frame.1")))


@step("hidden in the first view")
def hide(simple):
    simple.Hide(simple.GetActiveSource(), simple.GetRenderViews()[0])
    simple.RenderAllViews()


@step("shown again", look="like Rotate both")
def show(simple):
    simple.Show(simple.GetActiveSource(), simple.GetRenderViews()[0])
    simple.RenderAllViews()


# The view grows; until it has been drawn anew, which the next step sees to, it may show what it had.
events_only("Close", [(FRAME + "2/TitleBar/Close", "activate", "")], look="shown")


@step("one view")
def unsplit(simple):
    first = simple.GetActiveView()
    simple.GetLayout().SetSize(480, 400)
    simple.ResetCamera(first)
    simple.Render(first)


# -- Filters --------------------------------------------------------------------------------------------
events_only("Calculator, Apply", choose("menuFilters", "Calculator") + [
    (PANEL + "PropertiesFrame/ProxyPanel/Function/Function/OneLiner", "set_string", "coordsX+coordsZ"), APPLY,
] + show_as(TRACED), look="none")


@step("coloured by another array")
def color_by_other(simple):
    display = get_display(simple)
    display.DSMIsoArray = ["POINTS", "RTData"]
    display.DSMIsoValue = 150.0
    simple.ColorBy(display, ("POINTS", "Result"))
    display.RescaleTransferFunctionToDataRange()
    simple.GetScalarBar(simple.GetColorTransferFunction("Result"), simple.GetActiveView()).Visibility = 0
    simple.Render()


@step("Choose Preset")
def choose_preset(simple):
    simple.GetColorTransferFunction("Result").ApplyPreset("Black-Body Radiation", True)
    simple.Render()


events_only("Clip, Apply: a mesh", choose("menuFilters", "Clip") + [APPLY], look="shown")


@step("the mesh traced, without the plane's widget")
def trace_clip(simple):
    simple.HideInteractiveWidgets(proxy=simple.GetActiveSource().ClipType)
    set_display(simple, Representation=TRACED)


@step("with edges")
def show_edges(simple):
    set_display(simple, DSMShowEdges=1)


@step("its input beside it, as an isosurface", look="shown")
def show_input(simple):
    clipped = simple.GetActiveSource()
    display = simple.Show(clipped.Input, simple.GetActiveView())
    display.Representation = TRACED
    display.DSMIsoValue = 150.0
    simple.Render()


events_only("Delete the filter", menu("menu_Edit", "actionDelete"))
events_only("Contour, Apply: Surface", choose("menuFilters", "Contour") + [APPLY], look="shown")
events_only("Contour traced", show_as(TRACED))


@step("a sphere as well, as Surface")
def add_sphere(simple):
    view = simple.GetActiveView()
    sphere = simple.Sphere(Radius=6.0, Center=[8.0, 8.0, 8.0], ThetaResolution=40, PhiResolution=40)
    simple.Show(sphere, view).DiffuseColor = [0.4, 0.7, 0.9]
    simple.SetActiveSource(sphere)
    simple.Render()


@step("the sphere traced")
def trace_sphere(simple):
    set_display(simple, Representation=TRACED)


@step("larger, of fewer triangles")
def change_sphere(simple):
    sphere = simple.GetActiveSource()
    sphere.Radius = 9.0
    sphere.ThetaResolution = 12
    sphere.PhiResolution = 12
    simple.Render()


# -- Selecting ------------------------------------------------------------------------------------------
# Where a selection was made and cleared, 6.1 ends when the state is loaded, also without the plugin.
@step("Select Cells On", look="shown", until=(6, 1))
def select(simple):
    simple.SelectSurfaceCells(Rectangle=[200, 160, 300, 260], View=simple.GetActiveView())
    simple.Render()


@step("Clear Selection", look="like larger, of fewer triangles", until=(6, 1))
def clear_selection(simple):
    for source in simple.GetSources().values():
        simple.ClearSelection(source)
    simple.Render()


# -- Time -----------------------------------------------------------------------------------------------


@step("an animation of the isovalue", look="shown")
def animate(simple):
    wavelet = simple.FindSource("Wavelet1")
    view = simple.GetActiveView()
    for source in list(simple.GetSources().values()):
        simple.Hide(source, view)
    simple.SetActiveSource(wavelet)
    simple.Show(wavelet, view).Representation = TRACED
    track = simple.GetAnimationTrack("DSMIsoValue", 0, simple.GetDisplayProperties(wavelet, view))
    frames = []
    for time, value in ((0.0, 120.0), (1.0, 200.0)):
        frame = simple.CompositeKeyFrame()
        frame.KeyTime = time
        frame.KeyValues = [value]
        # As the Animation View does; since ParaView 5.13 a state as Python has only such key frames.
        simple.servermanager.ProxyManager().RegisterProxy("animation", f"KeyFrame{len(frames)}", frame)
        frames.append(frame)
    track.KeyFrames = frames
    simple.GetAnimationScene().NumberOfFrames = 3
    simple.GetAnimationScene().GoToFirst()


events_only("Next Frame", [("pqClientMainWindow/VCRToolbar/actionVCRNextFrame", "activate", "")])
events_only("Last Frame", [("pqClientMainWindow/VCRToolbar/actionVCRLastFrame", "activate", "")])


@step("Save Animation", look="shown")
def save_animation(simple):
    simple.SaveAnimation(os.path.join(os.environ["DSM_WORKDAY"], "animation.png"), simple.GetActiveView())


# -- What is kept ---------------------------------------------------------------------------------------


@step("Save Screenshot with a transparent background", look="shown")
def save_screenshot(simple):
    name = os.path.join(os.environ["DSM_WORKDAY"], "transparent.png")
    simple.SaveScreenshot(name, simple.GetActiveView(), TransparentBackground=1)


@step("Export Scene", look="shown")
def export(simple):
    simple.ExportView(os.path.join(os.environ["DSM_WORKDAY"], "scene.x3d"), simple.GetActiveView())


events_only("Save State", menu("menu_File", "actionFileSaveServerState") + [
    ("pqClientMainWindow/FileSaveServerStateDialog", "filesSelected", "@OUTPUT@/saved.pvsm"),
], look="shown")


@step("Save State as Python", look="shown")
def save_state(simple):
    from paraview import smstate

    with open(os.path.join(os.environ["DSM_WORKDAY"], "saved.py"), "w", encoding="utf-8") as text:
        text.write(smstate.get_state())


delete_all("Delete All")
LOAD_STATE = menu("menu_File", "actionFileLoadServerState") + [
    ("pqClientMainWindow/FileLoadServerStateDialog", "filesSelected", "@OUTPUT@/saved.pvsm"),
]
events_only("Load State", LOAD_STATE)
delete_all("Delete All once more")


@step("Load State from Python")
def load_state(simple):
    simple.RemoveViewsAndLayouts()  # the empty one
    with open(os.path.join(os.environ["DSM_WORKDAY"], "saved.py"), encoding="utf-8") as text:
        exec(compile(text.read(), "saved.py", "exec"), {"__name__": "state"})
    simple.RenderAllViews()


delete_all("Delete All a third time")
events_only("Load State again", LOAD_STATE, look="like Load State", only="server")
delete_all("Delete All at last", only="server")


# -- The server goes, and comes back -------------------------------------------------------------------
events_only("Disconnect", menu("menu_File", "actionServerDisconnect"), look="none", only="server")


def forget_left_session():
    """In ParaView 6.1 what Python knows of a session's sources keeps the session, and so the server, after Disconnect
    (docs/limits.md)."""
    from paraview import servermanager

    for thing in gc.get_objects():
        if type(thing).__name__ == "ProxyNamespace":
            thing.session = servermanager.ActiveConnection.Session


@step("a volume from the server's successor", look="shown", only="server")
def reconnect(simple):
    forget_left_session()
    port = int(os.environ["DSM_WORKDAY_PORT"])
    wait_until_listening(port)
    simple.Connect("127.0.0.1", port)
    # The plugin that the application has is loaded there by its name, without a word.
    view = simple.GetActiveViewOrCreate("RenderView")
    display = simple.Show(simple.Wavelet(), view)
    display.Representation = TRACED
    simple.ResetCamera(view)
    simple.Render(view)


delete_all("Delete All on it", only="server")
