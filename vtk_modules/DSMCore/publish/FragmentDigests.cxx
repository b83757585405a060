// SPDX-License-Identifier: BSD-3-Clause
#include "DSMCore/publish/FragmentDigests.h"

namespace dsm
{

void FragmentDigests::Add(const Fragment& fragment)
{
  if (fragment.Block < this->Digests.size())
  {
    this->Digests[fragment.Block].Add(fragment.Bytes.data(), fragment.Bytes.size());
  }
}

bool NotingFragmentSource::Next(Fragment& fragment)
{
  const bool any = this->Source.Next(fragment);
  if (any)
  {
    this->Digests.Add(fragment);
  }
  return any;
}

} // namespace dsm
