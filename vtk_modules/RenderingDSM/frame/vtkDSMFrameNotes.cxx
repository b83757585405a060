// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMFrameNotes.h"

#include "vtkDSMStatistics.h"

#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkStdString.h" // IWYU pragma: keep
#include "vtkTextProperty.h"
#include "vtkTextRenderer.h"

#include <algorithm>
#include <cstdint>

namespace
{

constexpr int DotsPerInch = 72;
constexpr int FontSize = 13;
/// Pixels.
constexpr int Border = 6;
constexpr int SwatchWidth = 18;
/// More would cover the picture.
constexpr std::size_t MostEntries = 16;

const glm::vec3 PanelColor(0.12f);

void SetPixel(rt::Picture& picture, int x, int y, const glm::vec3& color)
{
  const std::size_t pixel = static_cast<std::size_t>(y) * picture.Width + x;
  for (int channel = 0; channel < 3; ++channel)
  {
    picture.Color[4 * pixel + channel] =
      static_cast<std::uint8_t>(255.0f * glm::clamp(color[channel], 0.0f, 1.0f) + 0.5f);
  }
  picture.Color[4 * pixel + 3] = 255;
  picture.Depth[pixel] = 0.0f;
}

void Fill(rt::Picture& picture, int x, int y, int width, int height, const glm::vec3& color)
{
  for (int row = 0; row < height; ++row)
  {
    for (int column = 0; column < width; ++column)
    {
      SetPixel(picture, x + column, y + row, color);
    }
  }
}

/// Text as an image of its own.
class Lines
{
public:
  explicit Lines(const std::string& text)
  {
    vtkNew<vtkTextProperty> look;
    look->SetFontFamilyToCourier();
    look->SetFontSize(FontSize);
    look->SetColor(1.0, 1.0, 1.0);
    look->SetJustificationToLeft();
    look->SetVerticalJustificationToBottom();
    vtkTextRenderer* renderer = vtkTextRenderer::GetInstance();
    if (!renderer || text.empty() ||
      !renderer->RenderString(look, text.c_str(), this->Image, this->Size, DotsPerInch))
    {
      this->Size[0] = this->Size[1] = 0;
    }
  }

  bool IsEmpty() const { return this->Size[0] <= 0 || this->Size[1] <= 0; }
  int GetWidth() const { return this->Size[0]; }
  int GetHeight() const { return this->Size[1]; }

  /// Lower left corner at (x, y), over the panel's color.
  void Draw(rt::Picture& picture, int x, int y) const
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
        SetPixel(picture, x + column, y + row, glm::mix(PanelColor, color, ink[3] / 255.0f));
      }
    }
  }

private:
  vtkNew<vtkImageData> Image;
  int Size[2] = { 0, 0 };
};

bool Fits(const rt::Picture& picture, int width, int height)
{
  return width + 2 * Border <= picture.Width && height + 2 * Border <= picture.Height;
}

void DrawText(const std::string& text, rt::Picture& picture)
{
  const Lines lines(text);
  const int width = lines.GetWidth() + 2 * Border;
  const int height = lines.GetHeight() + 2 * Border;
  if (lines.IsEmpty() || !Fits(picture, width, height))
  {
    return;
  }
  const int bottom = picture.Height - Border - height;
  Fill(picture, Border, bottom, width, height, PanelColor);
  lines.Draw(picture, 2 * Border, bottom + Border);
}

void DrawLegend(const std::vector<vtkDSMFrameNotes::Entry>& legend, rt::Picture& picture)
{
  std::vector<Lines> texts;
  texts.reserve(legend.size());
  int textWidth = 0;
  int line = FontSize;
  for (const auto& entry : legend)
  {
    texts.emplace_back(entry.Text);
    if (texts.back().IsEmpty())
    {
      return;
    }
    textWidth = std::max(textWidth, texts.back().GetWidth());
    line = std::max(line, texts.back().GetHeight());
  }
  const int step = line + Border / 2;
  const int width = SwatchWidth + textWidth + 3 * Border;
  const int height = static_cast<int>(legend.size()) * step + 2 * Border;
  if (legend.empty() || !Fits(picture, width, height))
  {
    return;
  }
  Fill(picture, Border, Border, width, height, PanelColor);
  for (std::size_t number = 0; number < legend.size(); ++number)
  {
    const int y = Border + height - Border - static_cast<int>(number + 1) * step;
    Fill(picture, 2 * Border, y, SwatchWidth, line, legend[number].Color);
    texts[number].Draw(picture, 3 * Border + SwatchWidth, y);
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

void vtkDSMFrameNotes::Draw(
  const std::string& text, const std::vector<Entry>& legend, rt::Picture& picture)
{
  DrawText(text, picture);
  DrawLegend(legend, picture);
}
