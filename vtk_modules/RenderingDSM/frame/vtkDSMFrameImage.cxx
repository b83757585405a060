// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFrameImage.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace
{

/// The color of a row of the background, in bytes, as a graphics card makes it.
void GetBackground(const rt::Environment& background, int row, int height, std::uint8_t color[3])
{
  const float up = (static_cast<float>(row) + 0.5f) / static_cast<float>(height);
  for (int channel = 0; channel < 3; ++channel)
  {
    const float value = background.Lower[channel] * (1.0f - up) + background.Upper[channel] * up;
    color[channel] = static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
  }
}

/// A premultiplied pixel over a color.
void Blend(const std::uint8_t* pixel, const std::uint8_t under[3], std::uint8_t* out)
{
  const int left = 255 - pixel[3];
  for (int channel = 0; channel < 3; ++channel)
  {
    out[channel] = static_cast<std::uint8_t>(
      std::min(pixel[channel] + (left * under[channel] + 127) / 255, 255));
  }
  out[3] = 255;
}

void Divide(const std::uint8_t* pixel, std::uint8_t* out)
{
  const int part = pixel[3];
  for (int channel = 0; channel < 3; ++channel)
  {
    out[channel] = static_cast<std::uint8_t>(
      part > 0 ? std::min((255 * pixel[channel] + part / 2) / part, 255) : 0);
  }
  out[3] = pixel[3];
}

} // namespace

void vtkDSMFrameImage::Fill(vtkImageData* image, int width, int height, const rt::Picture& picture,
  const rt::Environment& background, bool transparent)
{
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("color");
  colors->SetNumberOfComponents(4);
  colors->SetNumberOfTuples(static_cast<vtkIdType>(width) * height);
  vtkNew<vtkFloatArray> depths;
  depths->SetName("depth");
  depths->SetNumberOfTuples(colors->GetNumberOfTuples());
  constexpr std::uint8_t nothing[4] = { 0, 0, 0, 0 };
  for (int row = 0; row < height; ++row)
  {
    std::uint8_t under[3];
    GetBackground(background, row, height, under);
    for (int column = 0; column < width; ++column)
    {
      const std::size_t place = static_cast<std::size_t>(row) * width + column;
      const bool isThere = !picture.Color.empty();
      const std::uint8_t* pixel = isThere ? &picture.Color[4 * place] : nothing;
      std::uint8_t* out = colors->GetPointer(static_cast<vtkIdType>(4 * place));
      if (transparent)
      {
        Divide(pixel, out);
      }
      else
      {
        Blend(pixel, under, out);
      }
      depths->SetValue(static_cast<vtkIdType>(place), isThere ? picture.Depth[place] : 1.0f);
    }
  }
  image->Initialize();
  image->SetDimensions(width, height, 1);
  image->GetPointData()->SetScalars(colors);
  image->GetPointData()->AddArray(depths);
  if (picture.Present.Has(rt::ChannelSet::Integral))
  {
    vtkNew<vtkFloatArray> integrals;
    integrals->SetName("integral");
    integrals->SetNumberOfTuples(colors->GetNumberOfTuples());
    std::copy_n(picture.Integral.data(), integrals->GetNumberOfTuples(), integrals->GetPointer(0));
    image->GetPointData()->AddArray(integrals);
  }
}
