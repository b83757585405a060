// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMVolumeData_h
#define vtkDSMVolumeData_h

#include "vtkDSMBlockLooks.h"
#include "vtkDSMImageArrays.h"
#include "vtkDSMPart.h"
#include "vtkDSMRankGroup.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

class vtkDataObject;

/// A dataset of images, of hyper tree grids and of curvilinear and unstructured grids, or AMR, that is distributed over
/// the ranks, sorted into the parts that are shown. Keeps the data alive, without a copy. Methods documented as
/// collective need every rank; a rank without data takes part. Failures are dsm::Error, the same on every rank.
class vtkDSMVolumeData
{
public:
  using Choice = vtkDSMImageArrays::Choice;
  /// One of each part; null where no piece of the part has the array.
  using Values = std::vector<std::shared_ptr<vtkDSMPartValues>>;
  /// Result of publishing an array.
  struct Publication
  {
    /// Its last user may take these apart.
    mutable Values Parts;
    std::uint64_t Content = 0; ///< see HashContent
  };
  /// The coarser levels of detail, from the first one on.
  using Coarser = std::vector<Values>;

  /// Which arrays are to be shown, of those that there are.
  using Chooser = std::function<std::vector<Choice>(const vtkDSMImageArrays&)>;

  /// Local. Returns whether a dataset that is not composite is a grid of values with a volume, of any kind that can be
  /// shown.
  static bool IsVolume(vtkDataObject* data);

  /// Collective. `data` is this rank's part: vtkImageData, vtkRectilinearGrid, vtkStructuredGrid, vtkUnstructuredGrid,
  /// vtkHyperTreeGrid, AMR, a composite dataset of any but AMR, whose other blocks are left out, or null; `looks` are
  /// of its blocks. Blocks that continue one another are taken for one volume, where the arrays that `choose` names
  /// agree at the points that the blocks have in common. `original`: the data with hidden blocks that `data` lack; may
  /// be null.
  vtkDSMVolumeData(std::shared_ptr<vtkDSMRankGroup> group, vtkDataObject* data,
    vtkDataObject* original, const Chooser& choose, const vtkDSMBlockLooks& looks);
  ~vtkDSMVolumeData();

  /// Returns whether the division of blocks into volumes depends on the arrays.
  bool HasSeams() const { return this->Seams; }
  /// The same on every rank.
  const std::vector<std::unique_ptr<vtkDSMPart>>& GetParts() const { return this->Parts; }
  const vtkDSMImageArrays& GetArrays() const { return this->Arrays; }
  /// Local, reads the data. Returns a hash of all that this rank's part of a field depends on: equal only if
  /// Publish would make the same again.
  std::uint64_t HashContent(const Choice& choice) const;
  /// Returns the bounds of all ranks' pieces; uninitialized bounds (min > max) if there are none.
  void GetBounds(double bounds[6]) const;

  /// Collective. Publishes an array of all parts, or finds the publication of the same values by another scene. The
  /// values leave the store when their last user releases them, which must happen in the same order on every rank.
  /// `old` (may be null) is taken over (MayTakeOver): then only bricks that differ are built and sent again.
  std::shared_ptr<const Publication> Publish(
    const vtkDSMPart::Request& request, std::shared_ptr<const Publication> old = nullptr) const;
  /// Local: whether the publication's memory may be used for other values of the same array. All ranks must say
  /// so.
  bool MayTakeOver(const std::shared_ptr<const Publication>& old) const;

  /// Collective. The coarser levels of what was published for the same request; none where a part has none. Room
  /// for their tables is what they take: they give way to nothing, and nothing gives way to them.
  std::shared_ptr<const Coarser> PublishCoarser(
    const Publication& finest, const vtkDSMPart::Request& request) const;

  /// Local: the levels of which a picture may show a box each, of a publication of one part; null: none.
  static const vtkDSMNestedLevels* FindNested(const Publication& publication);
  /// Collective, of a publication with such levels: vtkDSMPart::PublishBoxes.
  Values PublishBoxes(const Publication& finest, const vtkDSMNestedLevels::Boxes& boxes,
    const vtkDSMPart::Request& request, const Values& old) const
  {
    return this->Parts.front()->PublishBoxes(*finest.Parts.front(), boxes, request, old);
  }

private:
  /// Collective. Throws where the choice has a mask, but no piece has its array.
  void FindMask(const Choice& choice) const;

  std::shared_ptr<vtkDSMRankGroup> Group;
  bool Seams = false;
  std::vector<std::unique_ptr<vtkDSMPart>> Parts;
  vtkDSMImageArrays Arrays;
};

#endif
