// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMImageOrigin_h
#define vtkDSMImageOrigin_h

#include "DSMCore/transport/Messenger.h"
#include "DSMVolumeFiles/write/ValueOrigin.h"

#include "vtkDataArray.h"
#include "vtkSmartPointer.h"

#include <map>
#include <mutex>
#include <string>
#include <vector>

class vtkImageData;

/// The arrays of an image of which each rank has a piece. Pieces may overlap: values in several are taken from any
/// of them. A box that is read lies in one piece, or is gathered from all that have a part of it.
class vtkDSMImageOrigin final : public vol::ValueOrigin
{
public:
  /// Collective. `image`: this rank's piece, which must not change as long as this lives; null or empty: none. Throws
  /// dsm::Error, on every rank, when no rank has anything, when pieces leave something out, or when no array is in all.
  vtkDSMImageOrigin(dsm::Messenger& messenger, vtkImageData* image);

  const vol::FileGeometry& GetGeometry() const override { return this->Geometry; }
  const std::vector<vol::FileArray>& GetArrays() const override { return this->Arrays; }
  /// Differs for every process: values in memory are lost when it ends.
  std::string Describe() const override;
  std::vector<int> Deal(std::size_t array, const std::vector<bricks::Box>& boxes) override;
  void Read(std::size_t array, const bricks::Box& box, std::byte* out) const override;

  /// Names of arrays that are left out: not numbers, or not the same in all pieces.
  const std::vector<std::string>& GetLeftOut() const { return this->LeftOut; }

private:
  /// Collective: where the pieces are, of which First and Points are their own.
  std::vector<vol::FileGeometry> GatherPieces(vtkImageData* image);
  /// Collective.
  void GatherArrays(vtkImageData* image, const std::vector<vol::FileGeometry>& pieces);
  void CheckCover() const;
  /// Copies from this rank's piece.
  void Copy(std::size_t array, const bricks::Box& box, std::byte* out) const;

  /// Which of an array's samples each rank has; counted from the whole image's first.
  const std::vector<bricks::Box>& GetPieces(std::size_t array) const
  {
    return this->Arrays[array].OnCells ? this->CellsOfRanks : this->PointsOfRanks;
  }

  dsm::Messenger& Messenger;
  vol::FileGeometry Geometry;
  std::vector<vol::FileArray> Arrays;
  std::vector<std::string> LeftOut;
  std::vector<vtkSmartPointer<vtkDataArray>> Values; ///< this rank's piece; null without one
  std::vector<bricks::Box> PointsOfRanks;
  std::vector<bricks::Box> CellsOfRanks;
  /// Boxes of which no piece has all, that were dealt to this rank, by their first sample.
  std::map<std::vector<std::int64_t>, std::vector<std::byte>> Gathered;
  mutable std::mutex Lock; ///< for arrays that compute their values on demand
};

#endif
