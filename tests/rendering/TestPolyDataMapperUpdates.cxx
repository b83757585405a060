// SPDX-License-Identifier: BSD-3-Clause
// What is taken in anew, and what is said when that fails.
#include "PolyDataMapperTest.h"

#include "vtkDoubleArray.h"
#include "vtkLookupTable.h"
#include "vtkTestErrorObserver.h"

#include <algorithm>
#include <string>

TEST_F(PolyDataMapper, OnlyDataThatChangeAreTakenInAgain)
{
  const auto ball = MakeBall();
  this->Mapper->SetInputData(ball);
  const Picture first = this->Render();
  EXPECT_TRUE(this->Building);
  this->Renderer->GetActiveCamera()->Azimuth(20.0);
  this->Actor->RotateX(10.0);
  this->Actor->GetProperty()->SetOpacity(0.5);
  this->Actor->GetProperty()->SetDiffuseColor(0.0, 1.0, 0.0);
  this->Mapper->SetScalarRange(0.2, 0.5);
  this->Mapper->InterpolateScalarsBeforeMappingOn();
  vtkNew<vtkLookupTable> table;
  table->SetHueRange(0.0, 0.2);
  this->Mapper->SetLookupTable(table);
  EXPECT_NE(this->Render(), first);
  EXPECT_FALSE(this->Building) << "camera, matrix, material and colour map";
  // Filters make a new dataset of the old arrays.
  vtkNew<vtkPolyData> copy;
  copy->ShallowCopy(ball);
  this->Mapper->SetInputData(copy);
  this->Render();
  EXPECT_FALSE(this->Building) << "a copy of the structure";
  ball->GetPoints()->SetPoint(0, 0.0, 0.0, 1.5);
  ball->GetPoints()->Modified();
  this->Render();
  EXPECT_TRUE(this->Building) << "points";
  this->Mapper->ScalarVisibilityOff();
  this->Render();
  EXPECT_TRUE(this->Building) << "the colour array";
  this->Render();
  EXPECT_FALSE(this->Building);
}

TEST_F(PolyDataMapper, BuildingCanBeAborted)
{
  this->Mapper->SetInputDataObject(MakeBall());
  vtkNew<vtkCallbackCommand> abort;
  abort->SetClientData(this->Mapper);
  abort->SetCallback([](vtkObject*, unsigned long, void* mapper, void*)
    { static_cast<vtkDSMPolyDataMapper*>(mapper)->SetAbortExecute(1); });
  const unsigned long observer = this->Mapper->AddObserver(vtkCommand::ProgressEvent, abort);
  vtkNew<vtkTest::ErrorObserver> errors;
  this->Mapper->AddObserver(vtkCommand::ErrorEvent, errors);
  const Picture nothing = this->Render();
  EXPECT_EQ(std::count(nothing.begin(), nothing.end(), nothing.front()), nothing.size());
  EXPECT_NE(errors->GetErrorMessage().find("aborted"), std::string::npos);

  this->Mapper->RemoveObserver(observer);
  errors->Clear();
  this->Mapper->SetInputDataObject(MakeBall());
  EXPECT_NE(this->Render(), nothing);
  EXPECT_FALSE(errors->GetError());
}

TEST_F(PolyDataMapper, SaysWhatIsWrongOnceAndShowsTheRest)
{
  vtkNew<vtkTest::ErrorObserver> observer;
  this->Mapper->AddObserver(vtkCommand::ErrorEvent, observer);
  this->Mapper->AddObserver(vtkCommand::WarningEvent, observer);
  const auto ball = MakeBall();
  this->Mapper->SetInputData(ball);
  this->Render();
  this->Mapper->SetScalarModeToUsePointFieldData();
  this->Mapper->SelectColorArray("pressure");
  EXPECT_GT(CountCovered(this->Render()), 500);
  ASSERT_TRUE(observer->GetWarning());
  EXPECT_FALSE(observer->GetError()) << "VTK's mapper says nothing";
  std::string message = observer->GetWarningMessage();
  EXPECT_NE(message.find("'pressure'"), std::string::npos) << message;
  EXPECT_NE(message.find("'Elevation'"), std::string::npos) << message;
  observer->Clear();
  this->Render();
  EXPECT_FALSE(observer->GetWarning());

  vtkNew<vtkDoubleArray> shorter;
  shorter->SetName("shorter");
  shorter->SetNumberOfTuples(17);
  shorter->Fill(0.0);
  ball->GetCellData()->AddArray(shorter);
  this->Mapper->SetScalarModeToUseCellFieldData();
  this->Mapper->SelectColorArray("shorter");
  EXPECT_GT(CountCovered(this->Render()), 500);
  message = observer->GetErrorMessage();
  EXPECT_NE(message.find("'shorter' has 17 values"), std::string::npos) << message;
  observer->Clear();

  const auto broken = MakeCells({ { 0.0, 0.0 }, { 1.0, 0.0 }, { 0.0, 1.0 } });
  vtkNew<vtkCellArray> polygons;
  Connect(polygons, { 0, 1, 99 });
  broken->SetPolys(polygons);
  this->Mapper->ScalarVisibilityOff();
  this->Mapper->SetInputData(broken);
  EXPECT_EQ(CountCovered(this->Render()), 0);
  message = observer->GetErrorMessage();
  EXPECT_NE(message.find("point 99"), std::string::npos) << message;
  observer->Clear();
  this->Render();
  EXPECT_FALSE(observer->GetError());

  this->Mapper->SetInputData(ball);
  EXPECT_GT(CountCovered(this->Render()), 500);
  vtkNew<vtkPolyData> empty;
  this->Mapper->SetInputData(empty);
  EXPECT_EQ(CountCovered(this->Render()), 0);
  EXPECT_FALSE(observer->GetError());
}
