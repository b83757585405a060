// SPDX-License-Identifier: BSD-3-Clause
// Cells that the values of another array hide, beside blanked ones.
#include "VolumeMapperTest.h"

#include "vtkAppendFilter.h"
#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkDataSetAttributes.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkPointDataToCellData.h"
#include "vtkTestErrorObserver.h"
#include "vtkUniformGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVolumeProperty.h"

#include <functional>
#include <string>
#include <vector>

namespace
{

/// A ball with labels of its points and of its cells, in which cells are hidden by the labels or blanked.
class VolumeMapperOfMasks : public VolumeMapper
{
protected:
  VolumeMapperOfMasks()
  {
    vtkNew<vtkPointDataToCellData> toCells; // "distance" of the cells
    toCells->SetInputData(MakeBall());
    toCells->PassPointDataOn();
    toCells->Update();
    this->Image->ShallowCopy(toCells->GetOutput());
    this->AddLabels(this->Image->GetPointData(), this->Image->GetNumberOfPoints(), 11);
    this->AddLabels(this->Image->GetCellData(), this->Image->GetNumberOfCells(), 7);
    vtkNew<vtkColorTransferFunction> colors;
    colors->AddRGBPoint(0.0, 0.9, 0.2, 0.1);
    colors->AddRGBPoint(0.5, 0.2, 0.9, 0.3);
    vtkNew<vtkPiecewiseFunction> opacity;
    opacity->AddPoint(0.0, 0.3);
    vtkNew<vtkVolumeProperty> property;
    property->SetInterpolationTypeToLinear();
    property->SetColor(colors);
    property->SetScalarOpacity(opacity);
    this->Volume->SetProperty(property);
    this->Place();
    this->Renderer->AddVolume(this->Volume);
    this->Mapper->AddObserver(vtkCommand::ErrorEvent, this->Errors);
  }

  /// Slabs of four labels, 0 to 3, each `size` values.
  static void AddLabels(vtkDataSetAttributes* attributes, vtkIdType count, int size)
  {
    vtkNew<vtkUnsignedCharArray> labels;
    labels->SetName("labels");
    for (vtkIdType number = 0; number < count; ++number)
    {
      labels->InsertNextValue(static_cast<unsigned char>(number / (31 * size) % 4));
    }
    attributes->AddArray(labels);
  }

  /// A copy in which the cells are blanked that the labels hide.
  vtkSmartPointer<vtkImageData> MakeBlanked(
    bool onCells, const std::function<bool(double)>& isShown) const
  {
    auto blanked = vtkSmartPointer<vtkUniformGrid>::New();
    blanked->ShallowCopy(this->Image);
    vtkDataSetAttributes* const attributes = onCells
      ? static_cast<vtkDataSetAttributes*>(blanked->GetCellData())
      : blanked->GetPointData();
    vtkDataArray* const labels = attributes->GetArray("labels");
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    vtkNew<vtkIdList> points;
    for (vtkIdType cell = 0; cell < blanked->GetNumberOfCells(); ++cell)
    {
      bool isHidden = onCells && !isShown(labels->GetTuple1(cell));
      blanked->GetCellPoints(cell, points);
      for (vtkIdType corner = 0; !onCells && corner < points->GetNumberOfIds(); ++corner)
      {
        isHidden = isHidden || !isShown(labels->GetTuple1(points->GetId(corner)));
      }
      ghosts->InsertNextValue(isHidden ? vtkDataSetAttributes::HIDDENCELL : 0);
    }
    blanked->GetCellData()->AddArray(ghosts);
    return blanked;
  }

  vtkSmartPointer<vtkUnsignedCharArray> DrawPixels(vtkDataObject* data)
  {
    this->Mapper->SetInputDataObject(data);
    this->Window->Render();
    EXPECT_FALSE(this->Errors->GetError()) << this->Errors->GetErrorMessage();
    auto pixels = vtkSmartPointer<vtkUnsignedCharArray>::New();
    this->Window->GetPixelData(0, 0, Size - 1, Size - 1, 0, pixels);
    return pixels;
  }

  /// An isosurface, a medium and slices, each by point and by cell values, and a medium with an opacity array show what
  /// blanked cells leave.
  void ExpectSameAsBlanked(vtkDataSet* blanked)
  {
    this->ExpectSameAsBlanked(this->Image, blanked, { 0, 1, 2, 3, 4, 5, 6 });
  }
  void ExpectSameAsBlanked(vtkDataSet* data, vtkDataSet* blanked, const std::vector<int>& kinds)
  {
    for (const int kind : kinds)
    {
      SCOPED_TRACE(kind);
      this->Mapper->SetNumberOfIsoValues(0);
      this->Mapper->SetSlicing(kind % 3 == 2);
      this->Mapper->SetOpacityArray(kind == 6 ? "distance" : "");
      if (kind % 3 == 0 && kind < 6)
      {
        this->Mapper->SetIsoValue(0, 0.4);
      }
      this->Mapper->SetIsoArrayOnCells(kind >= 3 && kind < 6);
      const auto masked = this->DrawPixels(data);
      const std::string mask = this->Mapper->GetMaskArray();
      this->Mapper->SetMaskArray("");
      const auto whole = this->DrawPixels(data);
      EXPECT_EQ(GetDifference(this->DrawPixels(blanked), masked), 0.0);
      EXPECT_GT(GetDifference(whole, masked), 0.5);
      EXPECT_GT(masked->GetRange(0)[1], 100.0);
      this->Mapper->SetMaskArray(mask);
    }
  }

  vtkNew<vtkImageData> Image;
  vtkNew<vtkTest::ErrorObserver> Errors;
};

TEST_F(VolumeMapperOfMasks, HideTheCellsOfOtherValues)
{
  this->Mapper->AddSlice(2, -1);
  this->Mapper->SetMaskArray("labels");
  for (const bool onCells : { false, true })
  {
    SCOPED_TRACE(onCells);
    this->Mapper->SetMaskArrayOnCells(onCells);
    this->Mapper->SetMaskRange(1.0, 2.5);
    this->ExpectSameAsBlanked(
      this->MakeBlanked(onCells, [](double label) { return label == 1.0 || label == 2.0; }));
    this->Mapper->AddMaskValue(3.0);
    this->Mapper->AddMaskValue(0.0);
    this->ExpectSameAsBlanked(
      this->MakeBlanked(onCells, [](double label) { return label == 0.0 || label == 3.0; }));
    this->Mapper->RemoveAllMaskValues();
  }
  // Values that do not exist leave nothing.
  this->Mapper->SetMaskRange(7.0, 8.0);
  EXPECT_EQ(this->DrawPixels(this->Image)->GetRange(0)[1], 0.0);
}

TEST_F(VolumeMapperOfMasks, HideCellsOfUnstructuredGrids)
{
  vtkNew<vtkAppendFilter> toCells;
  toCells->SetInputData(this->Image);
  toCells->Update();
  vtkUnstructuredGrid* const cells = toCells->GetOutput();
  vtkNew<vtkPlane> plane;
  plane->SetNormal(0.3, 0.2, 1.0);
  vtkNew<vtkPlaneCollection> planes;
  planes->AddItem(plane);
  this->Mapper->SetSlicePlanes(planes);
  this->Mapper->SetMaskArray("labels");
  for (const bool onCells : { false, true })
  {
    SCOPED_TRACE(onCells);
    const auto ofImage =
      this->MakeBlanked(onCells, [](double label) { return label == 0.0 || label == 3.0; });
    vtkNew<vtkUnstructuredGrid> blanked;
    blanked->ShallowCopy(cells);
    blanked->GetCellData()->AddArray(
      ofImage->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName()));
    this->Mapper->SetMaskArrayOnCells(onCells);
    this->Mapper->AddMaskValue(3.0);
    this->Mapper->AddMaskValue(0.0);
    this->ExpectSameAsBlanked(
      cells, blanked, onCells ? std::vector<int>{ 2, 3 } : std::vector<int>{ 0, 6 });
    this->Mapper->RemoveAllMaskValues();
  }
}

TEST_F(VolumeMapperOfMasks, MakeNewBricksOnlyWhenTheyChange)
{
  int built = 0;
  vtkNew<vtkCallbackCommand> count;
  count->SetClientData(&built);
  count->SetCallback(
    [](vtkObject* caller, unsigned long, void* number, void*)
    {
      // The pipeline itself begins and ends, and tracing has a text.
      auto* const mapper = vtkDSMVolumeMapper::SafeDownCast(caller);
      const double part = mapper->GetProgress();
      *static_cast<int*>(number) += part > 0.0 && part < 1.0 && !mapper->GetProgressText() ? 1 : 0;
    });
  this->Mapper->SetInputData(this->Image);
  this->Mapper->AddObserver(vtkCommand::ProgressEvent, count);
  const auto isBuilt = [&]
  {
    built = 0;
    this->Mapper->SetIsoValue(0, this->Mapper->GetIsoValue(0) == 0.4 ? 0.39 : 0.4);
    this->Window->Render();
    return built > 0;
  };
  EXPECT_TRUE(isBuilt());
  EXPECT_FALSE(isBuilt());
  this->Mapper->SetMaskRange(1.0, 2.0);
  EXPECT_FALSE(isBuilt()) << "nothing is masked";
  this->Mapper->SetMaskArray("labels");
  EXPECT_TRUE(isBuilt());
  this->Mapper->RemoveAllMaskValues();
  EXPECT_FALSE(isBuilt());
  this->Mapper->AddMaskValue(3.0);
  EXPECT_TRUE(isBuilt());
  this->Mapper->RemoveAllMaskValues();
  this->Mapper->AddMaskValue(3.0);
  EXPECT_FALSE(isBuilt());
  // The mask's values change.
  vtkDataArray* const labels = this->Image->GetPointData()->GetArray("labels");
  labels->Fill(3.0);
  labels->Modified();
  this->Image->Modified();
  EXPECT_TRUE(isBuilt());
}

TEST_F(VolumeMapperOfMasks, ThatAreMissingAreErrors)
{
  this->Mapper->SetInputData(this->Image);
  this->Mapper->SetMaskArray("nothing");
  this->Window->Render();
  EXPECT_NE(this->Errors->GetErrorMessage().find("mask array 'nothing'"), std::string::npos)
    << this->Errors->GetErrorMessage();
  this->Errors->Clear();
  this->Mapper->SetMaskArray("labels");
  EXPECT_GT(this->DrawPixels(this->Image)->GetRange(0)[1], 100.0) << "any number is shown at first";
}

} // namespace
