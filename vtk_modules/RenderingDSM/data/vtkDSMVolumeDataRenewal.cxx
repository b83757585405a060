// SPDX-License-Identifier: BSD-3-Clause
// Other values for bricks that are there.
#include "vtkDSMVolumeData.h"

#include "DSMBricks/build/VoxelBrickBuilder.h"
#include "DSMCore/publish/SegmentUpdate.h"

#include <utility>

bool vtkDSMVolumeData::MayTakeOver(const std::shared_ptr<const Publication>& old) const
{
  if (!old || old.use_count() != 1 || !old->Levels.empty() || !this->Levels.empty() ||
    old->Parts.size() != this->GetNumberOfLattices())
  {
    return false;
  }
  for (std::size_t lattice = 0; lattice < old->Parts.size(); ++lattice)
  {
    const std::shared_ptr<bricks::VoxelField>& field = old->Parts[lattice].Field;
    const dsm::BlockStore& store = this->Group->GetStore();
    const auto mayChange = [&]
    {
      return old->Parts[lattice].Source ? store.MayRefresh(field->Segment)
                                        : store.MayUpdate(field->Segment);
    };
    // Bricks has a reference, too; no other object may have one.
    if (old->Bricks[lattice] &&
      (field.use_count() != 2 || !mayChange() ||
        field->Lattice.GetPoints() != this->Plan.GetLattices()[lattice].Points))
    {
      return false;
    }
  }
  return true;
}

void vtkDSMVolumeData::Renew(Publication::Part& part, Publication::Part&& old,
  const std::vector<std::shared_ptr<const bricks::VoxelSource>>& pieces, const std::string& what,
  const std::function<void(double)>& progress) const
{
  bricks::VoxelField& field = *part.Field;
  field.Segment = std::move(old.Field->Segment); // retired with the field, should anything fail
  const std::vector<bool> chosen =
    dsm::SegmentUpdate::GatherAny(this->Group->GetMessenger(), "Looking for changes",
      [&]
      {
        bricks::VoxelFragmentSource source(field.Lattice, pieces);
        dsm::NotingFragmentSource noting(source, part.Digests);
        for (dsm::Fragment fragment; noting.Next(fragment);)
        {
        }
        std::vector<bool> differ(part.Digests.GetCount());
        for (dsm::BlockId id = 0; id < differ.size(); ++id)
        {
          differ[id] = !part.Digests.IsSame(old.Digests, id);
        }
        return differ;
      });
  bricks::VoxelFragmentSource source(field.Lattice, pieces);
  source.Restrict(chosen);
  bricks::VoxelBrickSink sink(field.Lattice);
  this->Group->GetStore().Update(what, field.Segment, chosen, source, sink, progress);
}
