// SPDX-License-Identifier: BSD-3-Clause
#include "LookBenchmark.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

nlohmann::ordered_json BenchmarkLooks(dsm::Messenger& messenger, dsm::BlockStore& store,
  rt::FrameRenderer& renderer, const rt::Scene& scene, const rt::FrameRequest& request, int rounds)
{
  using Change = std::function<void(rt::Scene&)>;
  const auto getSurface = [](rt::Scene& some) -> rt::Material&
  { return std::get<rt::LatticeIsosurface>(some.Objects.front()).Look.Surface; };
  const std::vector<std::pair<std::string, Change>> changes{
    { "first", [](rt::Scene&) {} },
    { "color",
      [&](rt::Scene& some) {
        getSurface(some).DiffuseColor = { 0.2f, 0.5f, 0.9f };
      } },
    { "opacity", [&](rt::Scene& some) { getSurface(some).Opacity *= 0.5f; } },
    { "lamp", [](rt::Scene& some) { some.Lights.front().Color *= 0.5; } },
  };
  const auto trace = [&](const rt::Scene& some, const rt::FrameRequest& own)
  { return renderer.Render(store, some, own).Seconds; };
  std::vector<double> plain;
  std::vector<std::vector<double>> known(changes.size());
  std::vector<double> unknown;
  rt::FrameRequest own = request;
  for (int round = 0; round < rounds; ++round)
  {
    own.WorldToClip[3][0] += 1e-9; // another place
    own.KeepsHits = false;
    plain.push_back(trace(scene, own));
    rt::Scene translucent = scene;
    changes[2].second(translucent);
    unknown.push_back(trace(translucent, own));
    own.KeepsHits = true;
    for (std::size_t change = 0; change < changes.size(); ++change)
    {
      rt::Scene changed = scene;
      changes[change].second(changed);
      known[change].push_back(trace(changed, own));
    }
  }
  const auto getMedian = [](std::vector<double> values)
  {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  };
  nlohmann::ordered_json result{ { "seconds", getMedian(plain) } };
  for (std::size_t change = 0; change < changes.size(); ++change)
  {
    result[changes[change].first] = getMedian(known[change]) / getMedian(plain);
  }
  result["opacity_over_unknown"] = getMedian(known[2]) / getMedian(unknown);
  return messenger.GetRank() == 0 ? result : nlohmann::ordered_json();
}
