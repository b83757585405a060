// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFrameNotes.h"

#include "vtkDSMStatistics.h"

#include "DSMRayTracing/look/PackedColor.h"

#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkStdString.h" // IWYU pragma: keep
#include "vtkTextProperty.h"
#include "vtkTextRenderer.h"
#include "vtkWindow.h"

#include <algorithm>
#include <cstdint>

namespace
{

constexpr int FontSize = 13; ///< points
/// More would cover the picture.
constexpr std::size_t MostEntries = 16;
constexpr std::uint64_t MostLevels = 8;

const glm::vec3 PanelColor(0.12f);

/// The part of a view that a picture shows. Coordinates are pixels of the view.
struct Canvas
{
  Canvas(const vtkDSMFrameNotes::Place& place, rt::Picture& picture)
    : Place(place)
    , Picture(picture)
    , Border(this->ToPixels(6))
    , SwatchWidth(this->ToPixels(18))
  {
  }

  int ToPixels(int points) const { return std::max(1, points * this->Place.DotsPerInch / 72); }
  bool Fits(int width, int height) const
  {
    return width + 2 * this->Border <= this->Place.Width &&
      height + 2 * this->Border <= this->Place.Height;
  }

  void SetPixel(int x, int y, const glm::vec3& color)
  {
    x -= this->Place.Left;
    y -= this->Place.Bottom;
    if (x < 0 || y < 0 || x >= this->Picture.Width || y >= this->Picture.Height)
    {
      return;
    }
    const std::size_t pixel = static_cast<std::size_t>(y) * this->Picture.Width + x;
    for (int channel = 0; channel < 3; ++channel)
    {
      this->Picture.Color[4 * pixel + channel] = rt::PackedColor::ToByte(color[channel]);
    }
    this->Picture.Color[4 * pixel + 3] = 255;
    this->Picture.Depth[pixel] = 0.0f;
  }

  void Fill(int x, int y, int width, int height, const glm::vec3& color)
  {
    for (int row = 0; row < height; ++row)
    {
      for (int column = 0; column < width; ++column)
      {
        this->SetPixel(x + column, y + row, color);
      }
    }
  }

  const vtkDSMFrameNotes::Place& Place;
  rt::Picture& Picture;
  const int Border;
  const int SwatchWidth;
};

/// Text as an image of its own.
class Lines
{
public:
  Lines(const std::string& text, const Canvas& canvas)
  {
    vtkNew<vtkTextProperty> look;
    look->SetFontFamilyToCourier();
    look->SetFontSize(FontSize);
    look->SetColor(1.0, 1.0, 1.0);
    look->SetJustificationToLeft();
    look->SetVerticalJustificationToBottom();
    vtkTextRenderer* renderer = vtkTextRenderer::GetInstance();
    if (!renderer || text.empty() ||
      !renderer->RenderString(
        look, text.c_str(), this->Image, this->Size, canvas.Place.DotsPerInch))
    {
      this->Size[0] = this->Size[1] = 0;
    }
  }

  bool IsEmpty() const { return this->Size[0] <= 0 || this->Size[1] <= 0; }
  int GetWidth() const { return this->Size[0]; }
  int GetHeight() const { return this->Size[1]; }

  /// Lower left corner at (x, y), over the panel's color.
  void Draw(Canvas& canvas, int x, int y) const
  {
    // The text's lower left corner: some fonts and sizes put it below 0.
    const int* const first = this->Image->GetExtent();
    for (int row = 0; row < this->Size[1]; ++row)
    {
      for (int column = 0; column < this->Size[0]; ++column)
      {
        const auto* ink = static_cast<const std::uint8_t*>(
          this->Image->GetScalarPointer(first[0] + column, first[2] + row, 0));
        const glm::vec3 color = glm::vec3(ink[0], ink[1], ink[2]) / 255.0f;
        canvas.SetPixel(x + column, y + row, glm::mix(PanelColor, color, ink[3] / 255.0f));
      }
    }
  }

private:
  vtkNew<vtkImageData> Image;
  int Size[2] = { 0, 0 };
};

void DrawText(const std::string& text, Canvas& canvas)
{
  const Lines lines(text, canvas);
  const int border = canvas.Border;
  const int width = lines.GetWidth() + 2 * border;
  const int height = lines.GetHeight() + 2 * border;
  if (lines.IsEmpty() || !canvas.Fits(width, height))
  {
    return;
  }
  const int bottom = canvas.Place.Height - border - height;
  canvas.Fill(border, bottom, width, height, PanelColor);
  lines.Draw(canvas, 2 * border, bottom + border);
}

void DrawLegend(const std::vector<vtkDSMFrameNotes::Entry>& legend, Canvas& canvas)
{
  std::vector<Lines> texts;
  texts.reserve(legend.size());
  int textWidth = 0;
  int line = canvas.ToPixels(FontSize);
  for (const auto& entry : legend)
  {
    texts.emplace_back(entry.Text, canvas);
    if (texts.back().IsEmpty())
    {
      return;
    }
    textWidth = std::max(textWidth, texts.back().GetWidth());
    line = std::max(line, texts.back().GetHeight());
  }
  const int border = canvas.Border;
  const int step = line + border / 2;
  const int width = canvas.SwatchWidth + textWidth + 3 * border;
  const int height = static_cast<int>(legend.size()) * step + 2 * border;
  if (legend.empty() || !canvas.Fits(width, height))
  {
    return;
  }
  canvas.Fill(border, border, width, height, PanelColor);
  for (std::size_t number = 0; number < legend.size(); ++number)
  {
    const int y = height - static_cast<int>(number + 1) * step;
    canvas.Fill(2 * border, y, canvas.SwatchWidth, line, legend[number].Color);
    texts[number].Draw(canvas, 3 * border + canvas.SwatchWidth, y);
  }
}

} // namespace

std::vector<vtkDSMFrameNotes::Entry> vtkDSMFrameNotes::CreateLegend(
  rt::DebugView view, const vtkDSMStatistics* statistics)
{
  std::vector<Entry> legend;
  switch (view)
  {
    case rt::DebugView::Owner:
    case rt::DebugView::TracingRank:
    {
      const std::string what = view == rt::DebugView::Owner ? "owned by rank " : "traced by rank ";
      const auto ranks = static_cast<std::size_t>(statistics->GetNumberOfRanks());
      for (std::size_t rank = 0; rank < std::min(ranks, MostEntries); ++rank)
      {
        legend.push_back({ rt::GetNumberColor(rank),
          what + std::to_string(rank) + ", " + statistics->GetHost(static_cast<int>(rank)) });
      }
      if (ranks > MostEntries)
      {
        legend.push_back(
          { PanelColor, "and " + std::to_string(ranks - MostEntries) + " more ranks" });
      }
      break;
    }
    case rt::DebugView::Brick:
      legend = { { rt::GetNumberColor(0), "brick 0" }, { rt::GetNumberColor(1), "brick 1" },
        { rt::GetNumberColor(2), "brick 2, etc." } };
      break;
    case rt::DebugView::Level:
      for (std::uint64_t level = 0; level < MostLevels; ++level)
      {
        legend.push_back({ rt::GetNumberColor(level),
          "level " + std::to_string(level) + (level == 0 ? ", the finest" : "") });
      }
      break;
    case rt::DebugView::TileTime:
      for (const double part : { 0.0, 0.25, 0.5, 0.75, 1.0 })
      {
        const auto microseconds = static_cast<int>(1e6 * part * rt::LongTileSeconds + 0.5);
        legend.push_back({ rt::GetHeatColor(part),
          (part < 1.0 ? "" : ">= ") + std::to_string(microseconds) + " us per tile" });
      }
      break;
    case rt::DebugView::Normal:
      legend = { { { 1.0f, 0.5f, 0.5f }, "normal along +x" },
        { { 0.5f, 1.0f, 0.5f }, "normal along +y" }, { { 0.5f, 0.5f, 1.0f }, "normal along +z" } };
      break;
    case rt::DebugView::Depth:
      legend = { { glm::vec3(1.0f), "at the near plane" },
        { glm::vec3(0.0f), "at the far plane" } };
      break;
    case rt::DebugView::NewTiles:
      legend = { { rt::GetNewTileColor(), "tile traced by another rank before" },
        { glm::vec3(1.0f), "tile traced by the same rank before" } };
      break;
    case rt::DebugView::Misses:
      for (const double part : { 0.0, 0.25, 0.5, 0.75, 1.0 })
      {
        const auto bricks = static_cast<int>(part * rt::ManyMisses + 0.5);
        legend.push_back({ rt::GetHeatColor(part),
          (part < 1.0 ? "" : ">= ") + std::to_string(bricks) + " bricks missed" });
      }
      break;
    case rt::DebugView::Off:
      break;
  }
  return legend;
}

vtkDSMFrameNotes::Place vtkDSMFrameNotes::FindPlace(
  vtkRenderer* renderer, const rt::Picture& picture)
{
  Place place;
  place.Width = picture.Width;
  place.Height = picture.Height;
  vtkWindow* const window = renderer->GetVTKWindow();
  place.DotsPerInch = window->GetDPI();
  const int* const tiles = window->GetTileScale();
  if (tiles[0] * tiles[1] > 1)
  {
    const double* const tile = window->GetTileViewport();
    const double* const view = renderer->GetViewport();
    const int* const whole = window->GetSize(); // all tiles
    const auto toPixels = [&](int axis, double part)
    { return static_cast<int>(part * whole[axis] + 0.5); };
    place.Width = toPixels(0, view[2] - view[0]);
    place.Height = toPixels(1, view[3] - view[1]);
    place.Left = toPixels(0, std::max(tile[0] - view[0], 0.0));
    place.Bottom = toPixels(1, std::max(tile[1] - view[1], 0.0));
  }
  return place;
}

void vtkDSMFrameNotes::Draw(const std::string& text, const std::vector<Entry>& legend,
  const Place& place, rt::Picture& picture)
{
  if (picture.Width > 0)
  {
    Canvas canvas(place, picture);
    DrawText(text, canvas);
    DrawLegend(legend, canvas);
  }
}
