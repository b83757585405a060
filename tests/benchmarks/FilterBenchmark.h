// SPDX-License-Identifier: BSD-3-Clause
#ifndef FilterBenchmark_h
#define FilterBenchmark_h

#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/Scene.h"

#include <nlohmann/json.hpp>

/// Collective. Compares a picture of one sample for each pixel, whose light is filtered, with one of 16 samples, in
/// time and in errors beside one of 256. Errors are roots of mean squares, in 255ths: of all pixels, and of those that
/// a single sample shows as many do (no edges).
/// `rounds` in turn, of which the fastest counts. The result is the same on every rank.
nlohmann::ordered_json BenchmarkFilter(dsm::Messenger& messenger, dsm::BlockStore& store,
  rt::FrameRenderer& renderer, const rt::Scene& scene, const rt::FrameRequest& request, int rounds);

#endif
