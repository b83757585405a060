// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMImagePiece_h
#define vtkDSMImagePiece_h

#include "DSMBricks/base/ScalarType.h"
#include "DSMBricks/build/CellReader.h"
#include "DSMBricks/build/LatticePlan.h"
#include "DSMBricks/build/VoxelSource.h"
#include "DSMVolumeFiles/cache/FileSamples.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstdint>
#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;
class vtkUnsignedCharArray;

/// One vtkImageData or vtkRectilinearGrid of this rank ("image") as a piece of a lattice: one component of an array
/// of its points or cells, the magnitude of all, or the colors that they are (rt::PackedColor). Copies nothing;
/// reading is safe from any thread while the image is not modified.
class vtkDSMImagePiece final : public bricks::VoxelSource
{
public:
  /// Component that stands for the magnitude of all components.
  static constexpr int Magnitude = vol::FileSamples::Magnitude;
  /// Component that stands for the color that all components make, as VTK takes colors from arrays: gray, gray
  /// and opacity, color, color and opacity.
  static constexpr int Color = -2;

  /// The data set, if it is an image; else null.
  static vtkDataSet* FindImage(vtkDataObject* data);
  static void GetExtent(vtkDataSet* image, int extent[6]);

  /// Returns the data about an image that the other ranks need. Ghost cells are trimmed off; ghost
  /// and blanked cells that remain make a mask.
  static bricks::PieceInfo Describe(vtkDataSet* image, int leaf);

  /// Returns the coordinates of the points around the cells of a rectilinear grid, as Describe has trimmed them;
  /// none of other images.
  static bricks::GridPlanes::Coordinates GetCoordinates(
    vtkDataSet* image, const bricks::PieceInfo& info);

  /// One byte a cell of a box in the image's own indices, x fastest: 0 for blanked cells and copies of other
  /// pieces' cells, else 1. Cells that are marked as refined count as any others.
  static std::vector<std::uint8_t> FindShown(vtkDataSet* image, const bricks::Box& cells);

  /// Returns the magnitude of a tuple.
  static double GetMagnitude(vtkDataArray* array, vtkIdType tuple);

  /// Arrays keep their type; the magnitude is float where that holds it, else double; colors are packed.
  static bricks::ScalarType GetScalarType(vtkDataArray* array, int component);

  vtkDSMImagePiece(vtkDataSet* image, vtkDataArray* array, int component,
    const bricks::LatticePlan::Member& place, bool hasMask, bool ofCells = false);
  ~vtkDSMImagePiece() override;

  bricks::Box GetCells() const override { return this->Place.Cells; }
  void ReadSamples(const bricks::Box& points, std::byte* out) const override;
  bool HasCellMask() const override { return this->Masked; }
  void ReadCellMask(const bricks::Box& cells, std::uint8_t* out) const override;
  /// The box of the samples that the array has, also those of ghost cells, in lattice indices.
  const bricks::Box& GetSamples() const { return this->Samples; }
  /// For each cell of `cells`, which may be ghost cells, its bricks::CellReader::State.
  void ReadCellStates(const bricks::Box& cells, std::uint8_t* out) const;
  /// The samples at `part` of an array that has those of the box `all`; see GetScalarType.
  static void ReadSamples(vtkDataArray* array, int component, const bricks::Box& all,
    const bricks::Box& part, std::byte* out);

private:
  vtkSmartPointer<vtkDataSet> Image;
  vtkSmartPointer<vtkDataArray> Array;
  int Component;
  bricks::LatticePlan::Member Place;
  bool Masked;
  bricks::Box Samples; ///< that the array has, in lattice indices
};

#endif
