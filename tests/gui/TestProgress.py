# SPDX-License-Identifier: BSD-3-Clause
"""Run by ParaView's application, which has loaded the plugin, connected to a server: progress that
the application shows in the middle of a render, as a server's does while it builds the bricks of a large
volume, leaves the picture alone."""

from gui_testing import check, grab, run
from paraview import servermanager, simple
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm


class Progress:
    """Tells the application of progress whenever the view has been drawn but for what the server draws,
    which then is received and drawn."""

    def __init__(self, view):
        self.window = view.GetRenderWindow()
        self.taken = []  # whether the application had taken OpenGL away from the view
        self.handler = servermanager.ActiveConnection.Session.GetProgressHandler()
        self.handler.SetProgressInterval(0)
        self.algorithm = vtkAlgorithm()
        self.handler.RegisterProgressEvent(self.algorithm, 0)
        before_synchronization = 1.0
        view.GetRenderer().AddObserver("EndEvent", self.tell, before_synchronization)
        after_application = -0.5
        self.handler.AddObserver("ProgressEvent", self.look, after_application)

    def tell(self, *_):
        self.algorithm.UpdateProgress(0.4)

    def look(self, *_):
        self.taken.append(not self.window.IsCurrent())


def test(view):
    display = simple.Show(simple.Wavelet(), view)
    display.Representation = "DSM Ray Traced"
    display.DSMIsoValues = [157.0]
    simple.ResetCamera(view)
    simple.Render(view)
    undisturbed = grab(view)
    check(len(set(map(bytes, undisturbed))) > 50, "there is a picture")
    progress = Progress(view)
    display.DSMIsoValues = [140.0]
    simple.Render(view)
    check(any(progress.taken), "the application takes OpenGL to show progress")
    check((grab(view) != undisturbed).any(), "another isovalue has another picture")
    display.DSMIsoValues = [157.0]
    simple.Render(view)
    check((grab(view) == undisturbed).all(), "progress within a render leaves the picture alone")


simple.GetLayout().SetSize(600, 400)
view = simple.GetActiveViewOrCreate("RenderView")
view.OrientationAxesVisibility = 0
simple.Render(view)
# Once the application's window is there.
interactor = view.GetInteractor()
interactor.AddObserver("TimerEvent", lambda *_: run(lambda: test(view)))
interactor.CreateOneShotTimer(1000)
