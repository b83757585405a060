// SPDX-License-Identifier: BSD-3-Clause
#ifndef MediumBenchmark_h
#define MediumBenchmark_h

#include "VolumeOptions.h"

#include "DSMCore/transport/Messenger.h"

#include <string>
#include <vector>

/// Frames of a volume as a medium: how long they take, with several transfer functions, and how exact they are.
class MediumBenchmark
{
public:
  struct Options : VolumeOptions
  {
    Options() { this->Frames = 4; }

    std::vector<std::string> Functions{ "all" }; ///< names of MediumFunction::GetKinds, or all
    std::vector<dsm::MemoryOrganization> Stores{ dsm::MemoryOrganization::ObjectBased };
    std::string Shade = "both"; ///< on, off or both
    bool Reference = false;     ///< compares unshaded pictures with MediumReference
    int ReferenceSteps = 256;   ///< of a cell
    double Errors = 1.0;        ///< rt::LightTransport::MediumErrors

    /// Adds the options that change this object.
    void AddTo(CLI::App& app);
  };

  /// Collective. Prints on rank 0.
  static void Run(const Options& options, dsm::Messenger& messenger);
};

#endif
