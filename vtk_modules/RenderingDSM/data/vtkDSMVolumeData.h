// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMVolumeData_h
#define vtkDSMVolumeData_h

#include "DSMBricks/build/LatticePlan.h"
#include "DSMBricks/build/VoxelSource.h"
#include "DSMCore/fetch/ReadingSource.h"
#include "DSMCore/publish/FragmentDigests.h"
#include "DSMRayTracing/scene/Scene.h"
#include "vtkDSMBlockLooks.h"
#include "vtkDSMFileVolume.h"
#include "vtkDSMImageArrays.h"
#include "vtkDSMLevelData.h"
#include "vtkDSMRankGroup.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

class vtkDataObject;
class vtkDataSet;

/// A dataset of images and of hyper tree grids, or AMR, that is distributed over the ranks, as lattices and as
/// levels, with its arrays as fields of bricks. A part is a lattice, or one of the level data: lattices are
/// numbered first. Keeps the data alive, without a copy. Methods documented as collective need every rank; a rank
/// without data takes part. Failures are dsm::Error, the same on every rank.
class vtkDSMVolumeData
{
public:
  using Choice = vtkDSMImageArrays::Choice;
  /// One field a lattice; null where no piece of the lattice has the array.
  using Fields = std::vector<std::shared_ptr<const bricks::VoxelField>>;
  /// Result of publishing an array.
  struct Publication
  {
    /// Its last user may take these apart.
    mutable Fields Bricks;
    /// For each lattice: the file that it is in, or null.
    std::vector<std::shared_ptr<const vtkDSMFileVolume>> Files;
    /// One of each of the level data; null where these do not have the array.
    std::vector<std::shared_ptr<const bricks::LevelVoxels>> Levels;
    std::uint64_t Content = 0; ///< see HashContent

    /// Data for putting other values into a lattice's bricks.
    struct Part
    {
      std::shared_ptr<bricks::VoxelField> Field;
      dsm::FragmentDigests Digests; ///< digests of this rank's contributions
      /// For a lattice in a file, instead: the source of its bricks and, if there are several time
      /// steps, the digests of these bricks (else null).
      std::shared_ptr<dsm::ReadingSource> Source;
      std::shared_ptr<const vtkDSMFileVolume::Digests> Bricks;
    };
    /// One a lattice, likewise.
    mutable std::vector<Part> Parts;
  };

  /// An array's lattices at a coarser level of their files.
  struct CoarserLattice
  {
    std::shared_ptr<const bricks::VoxelField>
      Field;              ///< null where no piece of the lattice has the array
    glm::dmat4 ToLattice; ///< from its indices to the lattice's
  };
  struct Coarser
  {
    /// From the first coarser one on; each has all lattices.
    std::vector<std::vector<CoarserLattice>> Levels;
  };

  /// Which arrays are to be shown, of those that there are.
  using Chooser = std::function<std::vector<Choice>(const vtkDSMImageArrays&)>;

  /// Collective. `data` is this rank's part: vtkImageData, vtkRectilinearGrid, vtkHyperTreeGrid, AMR, a composite
  /// dataset of any but AMR, whose other blocks are left out, or null; `looks` are of its blocks. Blocks that
  /// continue one another are taken for one volume, where the arrays that `choose` names agree at the points that
  /// the blocks have in common. `original`: the data with hidden blocks that `data` lack; may be null.
  vtkDSMVolumeData(std::shared_ptr<vtkDSMRankGroup> group, vtkDataObject* data,
    vtkDataObject* original, const Chooser& choose, const vtkDSMBlockLooks& looks);
  ~vtkDSMVolumeData();

  /// Returns whether the division of blocks into volumes depends on the arrays.
  bool HasSeams() const { return this->Seams; }
  std::size_t GetNumberOfLattices() const { return this->Plan.GetLattices().size(); }
  const glm::dmat4& GetIndexToWorld(std::size_t lattice) const
  {
    return this->Plan.GetLattices()[lattice].IndexToWorld;
  }
  const vtkDSMLevelData& GetLevels(std::size_t number) const { return *this->Levels[number]; }
  std::size_t GetNumberOfParts() const { return this->GetNumberOfLattices() + this->Levels.size(); }
  using Block = vtkDSMLevelData::Block;
  /// Returns the blocks of a part, from all ranks' pieces.
  std::vector<Block> GetBlocks(std::size_t part) const;
  /// An image of this rank.
  struct OwnImage
  {
    vtkDataSet* Image;
    std::size_t Lattice;
    bricks::Index3 IndexToLattice; ///< add to the image's own index
    bricks::Box Cells;             ///< of the lattice, without ghosts around them
  };
  /// Local: this rank's images that have cells.
  std::vector<OwnImage> GetOwnImages() const
  {
    std::vector<OwnImage> images;
    for (std::size_t lattice = 0; lattice < this->GetNumberOfLattices(); ++lattice)
    {
      for (const bricks::LatticePlan::Member& member : this->Plan.GetLattices()[lattice].Members)
      {
        if (vtkDataSet* image = this->FindOwn(member))
        {
          images.push_back({ image, lattice, member.IndexToLattice, member.Cells });
        }
      }
    }
    return images;
  }
  const vtkDSMImageArrays& GetArrays() const { return this->Arrays; }
  /// Local, reads the data. Returns a hash of all that this rank's part of a field depends on: equal only if
  /// Publish would make the same again.
  std::uint64_t HashContent(const Choice& choice) const;
  /// Returns the bounds of all ranks' pieces; uninitialized bounds (min > max) if there are none.
  void GetBounds(double bounds[6]) const;

  /// Collective. Cuts an array into bricks and sends them to their owners, or finds the publication of the
  /// same values by another scene. `purpose` names the array in messages ("isosurface array"). The fields
  /// leave the store when their last user releases them, which must happen in the same order on every rank.
  /// `old` (may be null) is taken over (MayTakeOver): then only bricks that differ are built and sent again.
  std::shared_ptr<const Publication> Publish(const Choice& choice, const std::string& purpose,
    const std::function<void(double)>& progress,
    std::shared_ptr<const Publication> old = nullptr) const;
  /// Local: whether the publication's memory may be used for other values of the same array. All ranks must say
  /// so.
  bool MayTakeOver(const std::shared_ptr<const Publication>& old) const;

  /// Collective. The coarser levels of what was published for the same choice; none where a lattice is in no file,
  /// or in one without. Room for their tables is what they take: they give way to nothing, and nothing gives way to
  /// them.
  std::shared_ptr<const Coarser> PublishCoarser(const Publication& finest, const Choice& choice,
    const std::string& purpose, const std::function<void(double)>& progress) const;

private:
  /// Collective. Sorts this rank's data into images and parts of levels. Returns the looks of the images. `hasVolumes`:
  /// there are volumes here, which may be hidden.
  std::vector<vtkDSMBlockLook> Collect(
    vtkDataObject* data, const vtkDSMBlockLooks& looks, bool hasVolumes);
  /// Local. Adds the volumes of a dataset, which may be null, or of its blocks, hidden ones included.
  static void AddVolumes(vtkDataObject* data, std::vector<vtkSmartPointer<vtkDataObject>>& volumes);
  /// Distributes the coordinates of all rectilinear pieces, one piece and axis after the other.
  void SetCoordinates(const std::vector<double>& all);
  /// Collective: takes apart blocks that do not form one volume.
  void SeparateBlocks(const std::vector<Choice>& shown);
  /// Local: a piece's image, if it is this rank's; else null.
  vtkDataSet* FindOwn(const bricks::LatticePlan::Member& member) const;
  /// Local. Returns a hash of a piece's values at points of its lattice, in the shown arrays.
  std::uint64_t HashPoints(const bricks::LatticePlan::Member& member, const bricks::Box& points,
    const std::vector<Choice>& shown) const;
  /// Returns the values of this rank's first piece of a lattice that has the array in a file; null
  /// if there is none.
  const vtkDSMFileValues* FindFileValues(std::size_t lattice, const Choice& choice) const;
  /// Collective: a lattice that is in a file, for which `part` has a field. Its bricks come to memory when rays meet
  /// them. `old`: what is there of another step, or empty; bricks that are equal stay in memory.
  void PublishFile(const vtkDSMFileVolume& file, bool isCoarser, const vtkDSMFileValues* own,
    const std::string& what, const std::function<void(double)>& progress, Publication::Part& part,
    Publication::Part&& old) const;
  /// Adds it to the publication. `old`: what is there of an earlier time, or empty.
  void PublishLattice(Publication& published, std::size_t lattice, const Choice& choice,
    const std::string& purpose, const std::vector<vtkDSMImageArrays::Info>& infos,
    const std::vector<vtkDSMFileVolume::Seat>& seats, const std::function<void(double)>& progress,
    Publication::Part&& old) const;
  /// Collective: the old bricks, with what the pieces hold now.
  void Renew(Publication::Part& part, Publication::Part&& old,
    const std::vector<std::shared_ptr<const bricks::VoxelSource>>& pieces, const std::string& what,
    const std::function<void(double)>& progress) const;
  /// Local. A field that leaves the store with its last user.
  std::shared_ptr<bricks::VoxelField> MakeField() const;
  /// Local. A lattice's field without its bricks; null where no piece has the array.
  std::shared_ptr<bricks::VoxelField> CreateField(std::size_t lattice, const Choice& choice,
    const std::string& purpose, const std::vector<vtkDSMImageArrays::Info>& infos) const;
  /// Local. Returns whether some cells of a lattice have no value in an array, whatever the values are.
  bool HasGaps(std::size_t lattice, const std::vector<vtkDSMImageArrays::Info>& infos) const;
  /// Local. This rank's pieces of a lattice.
  std::vector<std::shared_ptr<const bricks::VoxelSource>> CreateSources(
    std::size_t lattice, const bricks::BrickLattice& bricks, const Choice& choice) const;
  /// Collective. The same for averages of cells, which other pieces have a part in. `infos`: of all ranks' pieces.
  std::vector<std::shared_ptr<const bricks::VoxelSource>> AverageCells(std::size_t lattice,
    const Choice& choice, const std::vector<vtkDSMImageArrays::Info>& infos,
    const std::string& what) const;

  std::shared_ptr<vtkDSMRankGroup> Group;
  bricks::LatticePlan Plan;
  std::vector<bricks::PieceInfo> Pieces;                    ///< all ranks' pieces, in rank order
  std::vector<bricks::GridPlanes::Coordinates> Coordinates; ///< of the pieces that are rectilinear
  std::vector<vtkDSMBlockLook> Looks;                       ///< looks of the pieces, in their order
  int FirstOwnPiece = 0;
  bool Seams = false;
  std::set<std::int32_t> Apart;                    ///< blocks that are volumes of their own
  std::vector<vtkSmartPointer<vtkDataSet>> Images; ///< this rank's images
  std::vector<int> Leaves;                         ///< leaf index of each of this rank's images
  vtkDSMLevelData::Parts LevelParts;               ///< this rank's
  std::vector<std::unique_ptr<vtkDSMLevelData>> Levels;
  vtkDSMImageArrays Arrays;
};

#endif
