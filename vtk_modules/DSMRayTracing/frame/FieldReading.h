// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FieldReading_h
#define rt_FieldReading_h

#include "DSMCore/base/WorkerSlots.h"
#include "DSMRayTracing/frame/ServedWork.h"
#include "DSMRayTracing/scene/FieldReader.h"

#include <memory>

namespace rt
{

/// One thread of each rank reads fields.
template <class Store>
class FieldReading final : private ServedWork<Store>
{
public:
  /// Collective; the store's BeginFrame is called before. Keeps references.
  FieldReading(Store& store, dsm::Messenger& messenger, WorkerPool& pool, dsm::WorkerSlots& slots)
    : ServedWork<Store>(store, messenger, pool)
    , Slots(slots)
  {
  }

  /// Collective: see FrameRenderer::Read.
  void Read(const char* what, dsm::FunctionRef<void(FieldReader&)> read)
  {
    this->Reads = read;
    this->Run(1, [] {});
    this->Finish(what);
  }

private:
  void Work(int index) override
  {
    auto& worker = this->Blocks.GetWorker(index);
    const dsm::WorkerSlots::Hold slot(this->Slots);
    this->Blocks.Enter(worker);
    this->Reads(*CreateFieldReader(this->Blocks, worker));
    this->Blocks.Leave(worker);
  }

  dsm::WorkerSlots& Slots;
  dsm::FunctionRef<void(FieldReader&)> Reads;
};

} // namespace rt

#endif
