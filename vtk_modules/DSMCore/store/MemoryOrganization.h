// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_MemoryOrganization_h
#define dsm_MemoryOrganization_h

namespace dsm
{

/// How a rank accesses blocks owned by other ranks.
enum class MemoryOrganization
{
  Automatic,   ///< Replicated where everything fits, else ObjectBased
  Replicated,  ///< everywhere; see ReplicatedStore
  ObjectBased, ///< fetched into a cache, through a table; see ObjectStore
  PageBased    ///< fetched into a cache, by page faults; see PagedStore
};

/// For texts: "object based".
constexpr const char* GetText(MemoryOrganization organization)
{
  switch (organization)
  {
    case MemoryOrganization::Automatic:
      return "automatic";
    case MemoryOrganization::Replicated:
      return "replicated";
    case MemoryOrganization::ObjectBased:
      return "object based";
    case MemoryOrganization::PageBased:
      return "page based";
  }
  return "unknown";
}

} // namespace dsm

#endif
