// SPDX-License-Identifier: BSD-3-Clause
#include "FilterBenchmark.h"

#include "tests/support/PictureError.h"

#include "DSMRayTracing/frame/FrameGather.h"
#include "DSMRayTracing/frame/LightFilter.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <vector>

namespace
{

/// Those of the pixels in which a picture shows anything.
std::vector<std::size_t> FindCovered(const rt::Picture& picture, std::vector<std::size_t> pixels)
{
  const auto isEmpty = [&](std::size_t pixel) { return picture.Color[4 * pixel + 3] == 0; };
  pixels.erase(std::remove_if(pixels.begin(), pixels.end(), isEmpty), pixels.end());
  return pixels;
}

} // namespace

nlohmann::ordered_json BenchmarkFilter(dsm::Messenger& messenger, dsm::BlockStore& store,
  rt::FrameRenderer& renderer, const rt::Scene& scene, const rt::FrameRequest& request, int rounds)
{
  using Clock = std::chrono::steady_clock;
  const auto trace = [&](const rt::Scene& some, int samples, bool isForFilter)
  {
    rt::FrameRequest own = request;
    own.Samples = samples;
    own.Channels.Value |= isForFilter ? rt::LightFilter::Channels : 0;
    return renderer.Render(store, some, own);
  };
  const auto gather = [&](const rt::Frame& frame) { return rt::GatherFrame(messenger, frame); };
  const double never = std::numeric_limits<double>::infinity();
  double plainSeconds = never;
  double filteredSeconds = never;
  double filterSeconds = never;
  rt::Picture plain;
  rt::Picture filtered;
  for (int round = 0; round < rounds; ++round)
  {
    const rt::Frame noisy = trace(scene, 1, false);
    plainSeconds = std::min(plainSeconds, noisy.Seconds);
    const rt::Frame forFilter = trace(scene, 1, true);
    const auto start = Clock::now();
    const rt::Frame smooth = renderer.FilterLight(store, request.WorldToClip, forFilter);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    filterSeconds = std::min(filterSeconds, seconds);
    filteredSeconds = std::min(filteredSeconds, forFilter.Seconds + seconds);
    plain = gather(noisy);
    filtered = gather(smooth);
  }
  rt::Scene unlit = scene;
  unlit.Transport = {};
  const rt::Picture one = gather(trace(unlit, 1, false));
  const rt::Picture many = gather(trace(unlit, 64, false));
  const auto inner = FindCovered(one, FindAlike(one, many, 2));
  const auto all = FindCovered(plain, FindAlike(plain, plain, 0));
  const rt::Picture sixteen = gather(trace(scene, 16, false));
  const rt::Picture exact = gather(trace(scene, 256, false));
  const auto compare = [&](const std::vector<std::size_t>& pixels)
  {
    return nlohmann::ordered_json{ { "pixels", pixels.size() },
      { "one_sample", GetError(plain, exact, pixels) },
      { "one_sample_filtered", GetError(filtered, exact, pixels) },
      { "sixteen_samples", GetError(sixteen, exact, pixels) } };
  };
  return { { "seconds", plainSeconds }, { "seconds_filtered", filteredSeconds },
    { "filter_seconds", filterSeconds }, { "errors_inside", compare(inner) },
    { "errors", compare(all) } };
}
