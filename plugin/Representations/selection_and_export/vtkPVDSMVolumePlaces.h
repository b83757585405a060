// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMVolumePlaces_h
#define vtkPVDSMVolumePlaces_h

#include "vtkSmartPointer.h"

#include <array>
#include <vector>

class vtkDSMScene;
class vtkDataObject;
class vtkDataSet;
class vtkMatrix4x4;
class vtkMultiBlockDataSet;
class vtkPointSet;
class vtkRenderer;

/// The places that the pixels of a picture of volumes show, for selections: where half of the light is covered.
/// Each rank draws those in its own data, as points that know their cells and the nearest points.
class vtkPVDSMVolumePlaces
{
public:
  /// Collective, unless the places are known: traces a picture of the renderer's size.
  void Find(vtkDSMScene* scene, vtkRenderer* renderer);
  void Forget();

  /// Makes the points of this rank's data, an image, a grid of cells, or a composite dataset of these.
  vtkSmartPointer<vtkMultiBlockDataSet> MakePoints(
    vtkDataObject* data, vtkMatrix4x4* dataToWorld) const;

private:
  using Place = std::array<double, 3>;
  class FoundPlaces;
  static void AddImage(vtkDataSet* image, const std::vector<Place>& places, FoundPlaces& found);
  static void AddGrid(vtkPointSet* grid, const std::vector<Place>& places, FoundPlaces& found);
  static void AddData(vtkDataObject* data, unsigned block, const std::vector<Place>& places,
    vtkMultiBlockDataSet* geometry);

  std::vector<Place> Places; ///< world
  bool AreKnown = false;
};

#endif
