// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMGridPlace_h
#define vtkPVDSMGridPlace_h

class vtkDataObject;
class vtkDataSet;

/// Places in images: vtkImageData and vtkRectilinearGrid.
class vtkPVDSMGridPlace
{
public:
  /// Returns the data as an image; null, if they are none or have no cells.
  static vtkDataSet* FindImage(vtkDataObject* data);
  static const int* GetExtent(vtkDataSet* image);
  /// Returns whether the points of both are among those of one lattice, so that a place in one is a place in the other.
  static bool HaveOneLattice(vtkDataSet* a, vtkDataSet* b);
  /// The place of a point among the image's samples, from its first one on; beyond its ends, in units of the last cell.
  static void Find(vtkDataSet* image, const double point[3], double place[3]);
};

#endif
