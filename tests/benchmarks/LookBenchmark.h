// SPDX-License-Identifier: BSD-3-Clause
#ifndef LookBenchmark_h
#define LookBenchmark_h

#include "DSMCore/store/BlockStore.h"
#include "DSMCore/transport/Messenger.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/Scene.h"

#include <nlohmann/json.hpp>

/// Collective. Times a picture whose first hits are kept, and then those of other colors, opacity and lamps from the
/// same place, over a picture that keeps nothing: medians of `rounds` in turn. The result is on rank 0.
nlohmann::ordered_json BenchmarkLooks(dsm::Messenger& messenger, dsm::BlockStore& store,
  rt::FrameRenderer& renderer, const rt::Scene& scene, const rt::FrameRequest& request, int rounds);

#endif
