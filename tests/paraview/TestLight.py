# SPDX-License-Identifier: BSD-3-Clause
"""Shadows, ambient occlusion, mirrors, translucency and samples per pixel: each changes the picture
as it should, and the picture is the same on any number of ranks."""

from dsm_testing import *

load_plugin()
view = create_view()
OPTIONS = ("DSMShadows", "DSMLightRadius", "DSMAmbientOcclusionSamples",
           "DSMAmbientOcclusionDistance", "DSMReflectivity", "DSMMaxBounces", "DSMSamplesPerPixel")

# Two balls over a floor.
volume = image_source("""
image.SetExtent(piece)
i, j, k = points(piece)
ball = np.sqrt((i - 14) ** 2 + (j - 22) ** 2 + (k - 20) ** 2) - 7
other = np.sqrt((i - 28) ** 2 + (j - 14) ** 2 + (k - 20) ** 2) - 6
floor = j - 4 + 0.02 * i
add(image, np.minimum(np.minimum(ball, other), floor))
""", (0, 40, 0, 40, 0, 40))
simple._DisableFirstRenderCameraReset()
display = show(volume, view, [0.0], "f")
view.AdditionalLights = [simple.CreateLight()]
lamp = view.AdditionalLights[0]
lamp.Coords = "Scene"
lamp.Position = [20.0, 90.0, 60.0]
lamp.FocalPoint = [20.0, 10.0, 20.0]
lamp.Type = "Directional"
view.UseLight = 0
view.UseFXAA = 0  # it would blur what is compared
view.CameraPosition = [30.0, 34.0, 66.0]
view.CameraFocalPoint = [20.0, 14.0, 20.0]
view.CameraViewUp = [0.0, 1.0, 0.0]
DEFAULTS = {option: display.GetPropertyValue(option) for option in OPTIONS}


def draw(name, **options):
    """With the options given, and the others as they are by default."""
    for option in OPTIONS:
        setattr(display, option, options.get(option, DEFAULTS[option]))
    return render(view, name)


plain = draw("plain")
covered = get_covered(plain)
check(covered.mean() > 0.15, f"the scene fills {100 * covered.mean():.0f} % of the view")
check_equal(render(view), plain, "a second frame is the same", 0)

shadows = draw("shadows", DSMShadows=1)
darker = (plain - shadows).max(axis=2) > 20
check(0.01 < darker.mean() < 0.4, f"{100 * darker.mean():.1f} % of the pixels are in shadow")
brighter = (shadows - plain).max()
check(brighter <= 1, f"shadows only darken: {brighter}")

soft = draw("soft", DSMShadows=1, DSMLightRadius=0.1, DSMSamplesPerPixel=16)
between = (plain - soft).max(axis=2)
check(((between > 10) & (between < 60)).sum() > ((plain - shadows).max(axis=2) > 10).sum() * 0.05,
      "soft shadows have a penumbra")

bright = draw(None, DSMSamplesPerPixel=4)
occluded = draw("occluded", DSMAmbientOcclusionSamples=4, DSMSamplesPerPixel=4)

def get_mean(pixels):
    return pixels[covered].mean()


check(get_mean(occluded) < get_mean(bright) - 1,
      f"occlusion darkens from {get_mean(bright):.1f} to {get_mean(occluded):.1f}")
near = draw("near", DSMAmbientOcclusionSamples=4, DSMSamplesPerPixel=4,
            DSMAmbientOcclusionDistance=8.0)
check(get_mean(occluded) < get_mean(near) < get_mean(bright),
      f"and only to {get_mean(near):.1f}, when it looks less far")

mirror = draw("mirror", DSMReflectivity=0.5)
check(abs(mirror - plain).max() > 30, "mirrors show something")
check_equal(draw(None, DSMReflectivity=0.5, DSMMaxBounces=0), plain, "but not without bounces", 0)

smooth = draw("smooth", DSMSamplesPerPixel=16)


def count_steps(pixels):
    """Neighbours in a row of which one is bright and the other is not."""
    return (abs(numpy.diff(pixels[:, :, 0], axis=1)) > 150).sum()


check(count_steps(smooth) < 0.7 * count_steps(plain),
      f"samples smooth edges: {count_steps(plain)} and {count_steps(smooth)} steep steps")
check_equal(draw(None, DSMSamplesPerPixel=16), smooth, "the samples are always the same", 0)
check_equal(draw("plainAgain"), plain, "and all can be switched off again", 0)

display.Opacity = 0.4
translucent = draw("translucent", DSMShadows=1)
check(abs(translucent - shadows).max() > 30, "what lies behind shows through")

# Light from all around: a white ball shows the mean of what its normals look at.
simple.Delete(volume)
ball = simple.Sphere(ThetaResolution=128, PhiResolution=96)
display = simple.Show(ball, view)
display.Representation = REPRESENTATION
display.ColorArrayName = [None, ""]
display.DiffuseColor = display.AmbientColor = [1.0, 1.0, 1.0]
lamp.Enable = 0
view.CameraParallelProjection = 1
place_camera(view, (0, 0, 1))
LOWER, UPPER = [0.1, 0.7, 0.0], [0.9, 0.2, 0.5]
display.DSMEnvironmentLight = 0.8


view.Background = LOWER
rows, columns = numpy.nonzero(get_covered(render(view)))
middle, radius = 0.5 * (rows.min() + rows.max()), 0.5 * (rows.max() - rows.min() + 1)
column = int(round(0.5 * (columns.min() + columns.max())))


def check_ball(name, upper):
    pixels = render(view, name)
    worst = 0
    for row in range(rows.min() + 6, rows.max() - 5):
        up = (row - middle) / radius
        light = [0.8 * (low + (high - low) * (0.5 + up / 3)) for low, high in zip(LOWER, upper)]
        worst = max(worst, abs(pixels[row, column] - 255 * numpy.array(light)).max())
    check(worst < 4, f"{name}: differs by {worst:.1f} from the integral")


check_ball("environment", LOWER)
view.Background2 = UPPER
view.BackgroundColorMode = "Gradient"
check_ball("gradient", UPPER)
