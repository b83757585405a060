// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMImageArrays_h
#define vtkDSMImageArrays_h

#include "DSMBricks/base/ScalarType.h"
#include "DSMBricks/base/ValidValues.h"
#include "DSMCore/base/Error.h"
#include "DSMCore/transport/Messenger.h"

#include "vtkSmartPointer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataObject;

/// The arrays of numbers of a dataset of images that is spread over the ranks: which there are, and whether one
/// serves as what the user chose it for.
class vtkDSMImageArrays
{
public:
  /// Values of another array whose cells are shown: all others hold no data. If the array is of points, all corners of
  /// a shown cell have such values.
  struct CellMask
  {
    std::string Name;     ///< empty: all cells are shown
    bool OnCells = false; ///< the cells' array of this name, not the points', is meant
    ///@{
    /// The range that is shown, while Values is empty.
    double Lowest = 0.0;
    double Highest = 0.0;
    ///@}
    std::vector<double> Values;

    /// Values must be in ascending order.
    bool Shows(double value) const
    {
      return this->Values.empty()
        ? value >= this->Lowest && value <= this->Highest
        : std::binary_search(this->Values.begin(), this->Values.end(), value);
    }
    bool operator==(const CellMask& other) const
    {
      return this->Name == other.Name && this->OnCells == other.OnCells &&
        this->Lowest == other.Lowest && this->Highest == other.Highest &&
        this->Values == other.Values;
    }
  };

  /// One array, as the user chose it.
  struct Choice
  {
    std::string Name;     ///< empty: the active scalars
    int Component = 0;    ///< also vtkDSMImagePiece::Magnitude and Color
    bool OnCells = false; ///< the cells' array of this name, not the points', is meant
    /// Of an array of cells: the values at points are the means of the cells around them, as for isosurfaces and media;
    /// else each cell has its value.
    bool IsAveraged = false;
    /// The user's; a file's own missing value is in Info.
    bricks::ValidValues Valid = {};
    CellMask Mask = {};

    bool HasMask() const { return !this->Mask.Name.empty(); }
    /// The mask's array, of whose components the first counts.
    Choice GetMaskArray() const { return { this->Mask.Name, 0, this->Mask.OnCells }; }

    bool operator==(const Choice& other) const
    {
      return this->Name == other.Name && this->Component == other.Component &&
        this->OnCells == other.OnCells && this->IsAveraged == other.IsAveraged &&
        this->Valid == other.Valid && this->Mask == other.Mask;
    }
  };

  /// Result of looking for a choice in an image.
  enum class State : std::int32_t
  {
    Usable,
    Missing,
    NotNumeric,
    OnCells,
    NoSuchComponent,
    NoColors,
    WrongLength
  };
  struct Info
  {
    State Found = State::Missing;
    bricks::ScalarType Type = bricks::ScalarType::Float32; ///< type of the resulting bricks
    std::int32_t Components = 0;
    /// By the choice and the array's file.
    bricks::ValidValues Valid = {};

    bool IsUsable() const { return this->Found == State::Usable; }
  };

  /// Thrown for an array that does not exist. The text is empty if a hidden part has the array: then there is no error.
  class Missing : public dsm::Error
  {
  public:
    using Error::Error;
  };

  vtkDSMImageArrays() = default;
  /// Collective. `parts`: this rank's, with attributes of points or of cells, or of both. `all`: the same with
  /// hidden ones.
  vtkDSMImageArrays(dsm::Messenger& messenger,
    const std::vector<vtkSmartPointer<vtkDataObject>>& parts,
    const std::vector<vtkSmartPointer<vtkDataObject>>& all = {});

  /// Null where the part's array is not usable; `info` says why.
  static vtkDataArray* Find(vtkDataObject* part, const Choice& choice, Info& info);

  /// The choice with its component made definite: an array of one component has but one. The same on
  /// every rank, also where there is no data.
  Choice Normalize(const Choice& choice) const;
  /// How many components the array has; 0 where there is none. The same on every rank.
  int CountComponents(const Choice& choice) const;
  /// Returns whether the array chosen as colors may have opacities. The same on every rank.
  bool HasOpacity(const Choice& choice) const;
  /// Throws a dsm::Error (Missing, if there is no such array) that says why the choice is not usable, and what is.
  /// `infos`: of all ranks' images; `purpose` names the array ("isosurface array").
  [[noreturn]] void Refuse(
    const Choice& choice, const std::string& purpose, const std::vector<Info>& infos) const;

private:
  /// All ranks' numeric ones, of points and of cells, and the active scalars, of no name: number of components.
  using Counts = std::array<std::map<std::string, int>, 2>;
  /// Collective.
  static Counts Gather(
    dsm::Messenger& messenger, const std::vector<vtkSmartPointer<vtkDataObject>>& parts);

  Counts Components;
  Counts WithHidden; ///< of hidden parts, too
};

#endif
