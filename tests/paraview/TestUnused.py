# SPDX-License-Identifier: BSD-3-Clause
"""A view has nothing of ours while no dataset is shown as ours, whatever else it shows."""

from dsm_testing import *

load_plugin()


def list_ours(view):
    """The classes of what is ours among the props that the renderer draws."""
    props = view.GetClientSideObject().GetRenderer().GetViewProps()
    shown = [props.GetItemAsObject(index) for index in range(props.GetNumberOfItems())]
    names = [prop.GetClassName() for prop in shown]
    names += [prop.GetMapper().GetClassName() for prop in shown
              if hasattr(prop, "GetMapper") and prop.GetMapper() and prop.GetVisibility()]
    return [name for name in names if "DSM" in name]


view = create_view()
sources = [simple.Wavelet(), simple.Sphere()]
for source in sources:
    simple.Show(source, view).Representation = "Surface"
simple.ResetCamera(view)
simple.Render(view)
check(list_ours(view) == [], f"a view of surfaces has nothing of ours: {list_ours(view)}")
displays = [simple.Show(source, view) for source in sources]
for display in displays:
    display.Representation = REPRESENTATION
simple.Render(view)
check("vtkDSMFrameProp" in list_ours(view), f"one of ours has: {list_ours(view)}")
