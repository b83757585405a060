# SPDX-License-Identifier: BSD-3-Clause
"""AMR and hyper tree grids: ParaView's sources of them."""

from dsm_testing import *

load_plugin()
view = create_view()


def show_levels(source, name, array=None, isovalues=None, is_recorded=True):
    """Without a message; the first array and isovalue are chosen where none are given."""
    for other in simple.GetSources().values():
        simple.Hide(other, view)
    with Messages() as messages:
        display = show_traced(source, view, **({"DSMIsoArray": ["CELLS", array]} if array else {}))
        if isovalues:
            display.DSMIsoValues = isovalues
        place_camera(view)
        render(view)
    pixels = render(view, name if is_recorded else None)
    check(not messages.text.strip(), f"{name}: no message: {messages.text.strip()}")
    check(get_covered(pixels).sum() > 20, f"{name}: something is shown")
    return display, pixels


pulse = simple.AMRGaussianPulseSource()
display, first = show_levels(pulse, "Pulse")
low, high = pulse.CellData.GetArray("Gaussian-Pulse").GetRange()
check(low < display.DSMIsoValue < high, f"Pulse: isovalue {display.DSMIsoValue} is chosen")
_, several = show_levels(pulse, "PulseSeveral", "Gaussian-Pulse", [0.05, 0.15, 0.3])
check((several != first).any(), "Pulse: several isovalues")
with Messages() as messages:
    simple.ColorBy(display, ("CELLS", "Centroid"))
    render(view)
colored = render(view, "PulseColors")
check(not messages.text.strip(), f"Pulse: colors without a message: {messages.text.strip()}")
check((colored != several).any(), "Pulse: colors by another array")

trees = simple.HyperTreeGridRandom()
show_levels(trees, "Trees", is_recorded=False)  # its values depend on the number of ranks
