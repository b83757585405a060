// SPDX-License-Identifier: BSD-3-Clause
#ifndef VolumeMapperCellsTest_h
#define VolumeMapperCellsTest_h

#include "VolumeMapperTest.h"

#include "vtkContourFilter.h"
#include "vtkTestErrorObserver.h"

/// Isosurfaces of the array `distance` of grids, beside VTK's.
class VolumeMapperCells : public VolumeMapper
{
protected:
  VolumeMapperCells() { this->Mapper->AddObserver(vtkCommand::ErrorEvent, this->Errors); }

  std::vector<double> Render(vtkDataObject* data)
  {
    this->Mapper->SetInputDataObject(data);
    std::vector<double> distances = this->RenderTraced();
    EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
    this->Errors->Clear();
    return distances;
  }
  std::vector<double> RenderContour(vtkDataObject* data)
  {
    vtkNew<vtkContourFilter> contour;
    contour->SetInputData(data);
    contour->SetInputArrayToProcess(0, 0, 0, vtkDataObject::POINT, "distance");
    contour->SetValue(0, this->Mapper->GetIsoValue(0));
    contour->ComputeNormalsOff();
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(contour->GetOutputPort());
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    this->Renderer->AddActor(actor);
    std::vector<double> distances = this->RenderDistances();
    this->Renderer->RemoveActor(actor);
    return distances;
  }
  /// Pixels covered, and distances in those that both cover.
  static void ExpectSame(const std::vector<double>& traced, const std::vector<double>& expected,
    double share = 0.005, double apart = 0.05)
  {
    int differing = 0;
    double sum = 0.0;
    int both = 0;
    for (std::size_t pixel = 0; pixel < traced.size(); ++pixel)
    {
      const bool isThere = std::isfinite(traced[pixel]);
      differing += isThere == std::isfinite(expected[pixel]) ? 0 : 1;
      if (isThere && std::isfinite(expected[pixel]))
      {
        ++both;
        sum += std::abs(traced[pixel] - expected[pixel]);
      }
    }
    EXPECT_GT(both, 1000);
    EXPECT_LE(differing, share * both);
    EXPECT_LE(sum, apart * both);
  }
  /// Expects an error that has a text.
  void ExpectError(vtkDataObject* data, const char* text)
  {
    this->Mapper->SetInputDataObject(data);
    EXPECT_EQ(CountCovered(this->RenderTraced()), 0);
    EXPECT_NE(this->Errors->GetErrorMessage().find(text), std::string::npos)
      << this->Errors->GetErrorMessage();
    this->Errors->Clear();
  }

  vtkNew<vtkTest::ErrorObserver> Errors;
};

#endif
