// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/look/TransferFunction2D.h"

#include "DSMBricks/base/ByteHash.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace rt
{

namespace
{

/// Extinction is not linear where opacity is: images of fewer texels on an axis are made finer.
constexpr int FineNodes = 512;
constexpr int MostParts = 16;

int GetParts(int texels)
{
  return std::clamp(FineNodes / texels, 1, MostParts);
}

glm::dvec4 Interpolate(const TransferFunction2D::Image& image, double column, double row)
{
  const auto split = [](double place, int count, int& first, int& next)
  {
    first = std::min(static_cast<int>(place), count - 1);
    next = std::min(first + 1, count - 1);
    return place - first;
  };
  int columns[2];
  int rows[2];
  const double across = split(column, image.Columns, columns[0], columns[1]);
  const double up = split(row, image.Rows, rows[0], rows[1]);
  const auto get = [&](int x, int y) {
    return image.Looks[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.Columns) + x];
  };
  return glm::mix(glm::mix(get(columns[0], rows[0]), get(columns[1], rows[0]), across),
    glm::mix(get(columns[0], rows[1]), get(columns[1], rows[1]), across), up);
}

} // namespace

TransferFunction2D::TransferFunction2D(
  const Image& image, const std::function<double(double)>& getExtinction, double cellLength)
  : ColumnParts(image.IsNearest ? 1 : GetParts(image.Columns))
  , RowParts(image.IsNearest ? 1 : GetParts(image.Rows))
  , IsNearest(image.IsNearest)
{
  this->Columns = static_cast<std::size_t>((image.Columns - 1) * this->ColumnParts + 1);
  this->Rows = static_cast<std::size_t>((image.Rows - 1) * this->RowParts + 1);
  this->SetNodes(image, getExtinction);
  this->SetEnvelope(image, cellLength);

  const double texel = (image.Values.y - image.Values.x) / image.Columns;
  this->FirstPlace = this->Envelope->GetPlace(image.Values.x + 0.5 * texel);
  this->ColumnsInBin = this->ColumnParts / (texel * this->Envelope->GetScale());
  const double step = (image.Seconds.y - image.Seconds.x) / image.Rows;
  this->FirstSecond = image.Seconds.x + 0.5 * step;
  this->RowsInUnit = this->RowParts / step;

  bricks::ByteHash hash;
  const std::uint64_t ofEnvelope = this->Envelope->GetDigest();
  hash.Add(&ofEnvelope, sizeof(ofEnvelope));
  hash.Add(&image.Columns, sizeof(image.Columns));
  hash.Add(&image.Rows, sizeof(image.Rows));
  hash.Add(&image.Values, sizeof(image.Values));
  hash.Add(&image.Seconds, sizeof(image.Seconds));
  hash.Add(&image.IsNearest, sizeof(image.IsNearest));
  for (const Node& node : this->Nodes)
  {
    hash.Add(&node.Emission, sizeof(node.Emission));
  }
  this->Digest = hash.Get();
}

void TransferFunction2D::SetNodes(
  const Image& image, const std::function<double(double)>& getExtinction)
{
  this->Nodes.reserve(this->Columns * this->Rows);
  for (std::size_t row = 0; row < this->Rows; ++row)
  {
    bool isSeen = false;
    for (std::size_t column = 0; column < this->Columns; ++column)
    {
      const glm::dvec4 look = Interpolate(image, static_cast<double>(column) / this->ColumnParts,
        static_cast<double>(row) / this->RowParts);
      const double extinction = getExtinction(look.w);
      const glm::dvec3 emission = extinction * glm::dvec3(look);
      Node node{ { emission.x, emission.y, emission.z, extinction }, Lanes(0.0) };
      if (column > 0)
      {
        const Node& before = this->Nodes.back();
        node.Integral = before.Integral + Lanes(0.5) * (before.Emission + node.Emission);
      }
      isSeen = isSeen || extinction > 0.0;
      this->Nodes.push_back(node);
    }
    this->IsSeen.push_back(isSeen ? 1 : 0);
  }
}

glm::dvec4 TransferFunction2D::GetLook(const Node& node)
{
  const double extinction = node.Emission[3];
  const double part = extinction > 0.0 ? 1.0 / extinction : 0.0;
  return { node.Emission[0] * part, node.Emission[1] * part, node.Emission[2] * part, extinction };
}

void TransferFunction2D::SetEnvelope(const Image& image, double cellLength)
{
  const double texel = (image.Values.y - image.Values.x) / image.Columns;
  std::vector<FunctionSample> samples;
  std::vector<std::size_t> columns; // of the samples
  const auto add = [&](double value, std::size_t column)
  {
    const Node* most = &this->Nodes[column];
    for (std::size_t row = 1; row < this->Rows; ++row)
    {
      const Node* const node = this->GetRow(row) + column;
      most = node->Emission[3] > most->Emission[3] ? node : most;
    }
    samples.push_back({ value, GetLook(*most) });
    columns.push_back(column);
  };
  if (!this->IsNearest)
  {
    add(image.Values.x, 0);
  }
  for (std::size_t column = 0; column < this->Columns; ++column)
  {
    const double place = static_cast<double>(column) / this->ColumnParts;
    if (this->IsNearest)
    {
      add(image.Values.x + texel * place, column);
      add(image.Values.x + texel * (place + 1.0), column);
      continue;
    }
    add(image.Values.x + texel * (place + 0.5), column);
  }
  if (!this->IsNearest)
  {
    add(image.Values.y, this->Columns - 1);
  }
  std::vector<std::vector<glm::dvec4>> rows(this->Rows);
  for (std::size_t row = 0; row < this->Rows; ++row)
  {
    for (const std::size_t column : columns)
    {
      rows[row].push_back(GetLook(this->GetRow(row)[column]));
    }
  }
  this->Envelope = std::make_shared<const TransferFunction>(samples, cellLength, rows);
}

Lanes TransferFunction2D::Integrate(const Node* row, double column) const
{
  if (!(column > 0.0))
  {
    return row->Emission * Lanes(column);
  }
  const std::size_t last = this->Columns - 1;
  const auto node = static_cast<std::size_t>(std::min(column, static_cast<double>(last)));
  const Lanes within(column - static_cast<double>(node));
  const Node& begin = row[node];
  const Lanes growth = node < last ? row[node + 1].Emission - begin.Emission : Lanes(0.0);
  return begin.Integral + within * (begin.Emission + Lanes(0.5) * within * growth);
}

Lanes TransferFunction2D::Evaluate(const Node* row, double column) const
{
  const std::size_t last = this->Columns - 1;
  const double held = std::clamp(column, 0.0, static_cast<double>(last));
  const auto node = static_cast<std::size_t>(held);
  const Lanes growth = node < last ? row[node + 1].Emission - row[node].Emission : Lanes(0.0);
  return row[node].Emission + Lanes(held - static_cast<double>(node)) * growth;
}

Lanes TransferFunction2D::GetRowMean(std::size_t row, double begin, double end) const
{
  if (!this->IsSeen[row])
  {
    return Lanes(0.0);
  }
  // The difference of two integrals would be rounding.
  constexpr double shortWay = 1e-5;
  const Node* const nodes = this->GetRow(row);
  return std::abs(end - begin) < shortWay
    ? this->Evaluate(nodes, 0.5 * (begin + end))
    : (this->Integrate(nodes, end) - this->Integrate(nodes, begin)) * Lanes(1.0 / (end - begin));
}

Lanes TransferFunction2D::GetNearest(double column, double row) const
{
  const auto round = [](double place, std::size_t count)
  {
    return static_cast<std::size_t>(std::clamp(place + 0.5, 0.0, static_cast<double>(count) - 0.5));
  };
  return this->GetRow(round(row, this->Rows))[round(column, this->Columns)].Emission;
}

Lanes TransferFunction2D::GetMean(double row, double begin, double end) const
{
  const double held = std::clamp(row, 0.0, static_cast<double>(this->Rows - 1));
  const auto lower = static_cast<std::size_t>(held);
  const double share = held - static_cast<double>(lower);
  const Lanes mean = this->GetRowMean(lower, begin, end) * Lanes(1.0 - share);
  return share > 0.0 ? mean + this->GetRowMean(lower + 1, begin, end) * Lanes(share) : mean;
}

template <class Add>
void TransferFunction2D::VisitParts(
  const glm::dvec2& begin, const glm::dvec2& end, const Add& add) const
{
  // The row hardly changes in a part.
  constexpr double partsInRow = 2.0;
  constexpr double leastParts = 2.0;
  constexpr double mostParts = 64.0;
  const double first = this->GetColumn(begin.x);
  const double firstRow = this->GetRowNumber(begin.y);
  const double columns = this->GetColumn(end.x) - first;
  const double rows = this->GetRowNumber(end.y) - firstRow;
  if (!std::isfinite(firstRow) || !std::isfinite(rows))
  {
    return;
  }
  if (this->IsNearest)
  {
    add(this->GetNearest(first + 0.5 * columns, firstRow + 0.5 * rows), 1.0);
    return;
  }
  const double count = std::clamp(std::ceil(partsInRow * std::abs(rows)), leastParts, mostParts);
  for (double part = 0.0; part < count; ++part)
  {
    const double from = first + part / count * columns;
    const double to = first + (part + 1.0) / count * columns;
    add(this->GetMean(firstRow + (part + 0.5) / count * rows, from, to), 1.0 / count);
  }
}

Lanes TransferFunction2D::GetAmount(
  const glm::dvec2& begin, const glm::dvec2& middle, const glm::dvec2& end, double length) const
{
  // Opacity over depth.
  const auto getSeen = [](double depth)
  { return depth > 1e-6 ? -std::expm1(-depth) / depth : 1.0 - 0.5 * depth; };
  Lanes seen(0.0);
  double depth = 0.0;
  const auto add = [&](const Lanes& mean, double part)
  {
    const Lanes amount = mean * Lanes(0.5 * part * length);
    if (amount[3] > 0.0)
    {
      seen = seen + amount * Lanes(std::exp(-depth) * getSeen(amount[3]));
      depth += amount[3];
    }
  };
  this->VisitParts(begin, middle, add);
  this->VisitParts(middle, end, add);
  const Lanes whole = seen * Lanes(1.0 / getSeen(depth));
  return { whole[0], whole[1], whole[2], depth };
}

} // namespace rt
