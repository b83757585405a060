// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_MpiTransport_h
#define dsm_MpiTransport_h

#include "DSMCore/transport/Transport.h"

#include <memory>

namespace dsm
{

/// Messages over MPI, on a duplicate of the given communicator, from the one thread that may call
/// MPI (MPI_THREAD_SINGLE suffices). Its source is the only file that includes mpi.h.
class MpiTransport
{
public:
  /// Collective over the communicator. `communicator` points to an MPI_Comm (kept opaque so that
  /// no header needs MPI); null means MPI_COMM_WORLD. Returns null when MPI is not initialized or
  /// the library was built without it. The destructor is not collective: the duplicate is freed by the next Create, or
  /// before MPI is finalized. Throws Error with MPI's own text.
  static std::unique_ptr<Transport> Create(const void* communicator);

  /// For programs without another owner of MPI (tests, dsm_bench): initializes MPI now and finalizes it on
  /// destruction. Does nothing when MPI is absent or already initialized.
  class Environment
  {
  public:
    Environment(int& argc, char**& argv);
    ~Environment();
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

  private:
    bool Owner = false;
  };
};

} // namespace dsm

#endif
