// SPDX-License-Identifier: BSD-3-Clause
// Surfaces as any VTK application draws them, without ParaView: against VTK's own mapper with the
// same actor.
#include "PolyDataMapperTest.h"

#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkPlane.h"
#include "vtkScalarsToColors.h"
#include "vtkTexture.h"
#include "vtkUnsignedCharArray.h"

TEST_F(PolyDataMapper, DrawsWhatVtkDraws)
{
  const auto ball = MakeBall();
  this->Mapper->SetInputData(ball);
  this->Mapper->ScalarVisibilityOff();
  this->Actor->SetPosition(0.2, -0.1, 0.3);
  this->Actor->SetScale(1.2, 0.7, 1.0);
  this->Actor->RotateY(30.0);
  this->Actor->GetProperty()->SetColor(0.9, 0.4, 0.3);
  this->Actor->GetProperty()->SetAmbient(0.2);
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball));
  this->Actor->GetProperty()->SetInterpolationToFlat();
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball));
}

TEST_F(PolyDataMapper, ACopyHasAllThatWasSet)
{
  const auto ball = MakeBall();
  this->Mapper->SetInputData(ball);
  this->Mapper->SetLineRadius(0.01);
  this->Mapper->SetPointRadius(0.02);
  this->Mapper->SetRadiusArray("Elevation");
  this->Mapper->MakesSceneOff();
  vtkNew<vtkCompositeDataDisplayAttributes> blocks;
  this->Mapper->SetCompositeDataDisplayAttributes(blocks);
  vtkNew<vtkDSMPolyDataMapper> copy;
  copy->ShallowCopy(this->Mapper);
  EXPECT_EQ(copy->GetInputDataObject(0, 0), ball);
  EXPECT_EQ(copy->GetLineRadius(), 0.01);
  EXPECT_EQ(copy->GetPointRadius(), 0.02);
  EXPECT_EQ(copy->GetRadiusArray(), "Elevation");
  EXPECT_FALSE(copy->GetMakesScene());
  EXPECT_EQ(copy->GetCompositeDataDisplayAttributes(), blocks);
  EXPECT_EQ(copy->GetLightOptions(), this->Mapper->GetLightOptions());
  EXPECT_EQ(copy->GetMemoryOptions(), this->Mapper->GetMemoryOptions());
}

TEST_F(PolyDataMapper, NormalsOfCellsAreUsedWherePointsHaveNone)
{
  const auto ball = MakeBall();
  ball->GetPointData()->SetNormals(nullptr);
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  for (vtkIdType cell = 0; cell < ball->GetNumberOfCells(); ++cell)
  {
    normals->InsertNextTuple3(0.2 * static_cast<double>(cell % 5), 0.3, 1.0);
  }
  this->Mapper->SetInputData(ball);
  this->Mapper->ScalarVisibilityOff();
  const Picture without = this->Render();
  ball->GetCellData()->SetNormals(normals);
  const Picture with = this->Render();
  EXPECT_TRUE(this->Building);
  EXPECT_NE(with, without);
  ExpectAlike(with, this->RenderWithTriangles(ball), 0.02);
  this->Actor->GetProperty()->SetInterpolationToFlat();
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.02);
}

TEST_F(PolyDataMapper, ClipsAsVtkDoes)
{
  const auto ball = MakeBall();
  this->Mapper->SetInputData(ball);
  this->Actor->SetPosition(0.2, -0.1, 0.3);
  this->Actor->RotateY(30.0);
  const int whole = CountCovered(this->Render());
  vtkNew<vtkPlane> front;
  front->SetOrigin(0.0, 0.0, 0.35);
  front->SetNormal(0.1, 0.2, -0.5);
  vtkNew<vtkPlane> side;
  side->SetOrigin(0.15, 0.0, 0.0);
  side->SetNormal(1.0, -0.3, 0.0);
  this->Mapper->AddClippingPlane(front);
  this->Mapper->AddClippingPlane(side);
  const Picture clipped = this->Render();
  EXPECT_LT(CountCovered(clipped), 0.9 * whole);
  ExpectAlike(clipped, this->RenderWithTriangles(ball));
  this->Mapper->RemoveAllClippingPlanes();
  EXPECT_EQ(CountCovered(this->Render()), whole);
}

TEST_F(PolyDataMapper, ColoursAreVtks)
{
  const auto ball = MakeBall();
  vtkNew<vtkDoubleArray> cells;
  cells->SetName("cells");
  vtkNew<vtkUnsignedCharArray> direct;
  direct->SetName("direct");
  direct->SetNumberOfComponents(3);
  for (vtkIdType cell = 0; cell < ball->GetNumberOfCells(); ++cell)
  {
    cells->InsertNextValue(static_cast<double>(cell % 7));
  }
  for (vtkIdType point = 0; point < ball->GetNumberOfPoints(); ++point)
  {
    direct->InsertNextTuple3(static_cast<double>(point % 255), 100.0, 20.0);
  }
  ball->GetCellData()->AddArray(cells);
  ball->GetPointData()->AddArray(direct);
  this->Mapper->SetInputData(ball);
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.01); // the active scalars
  this->Mapper->InterpolateScalarsBeforeMappingOn();
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.01);
  this->Mapper->SetScalarRange(0.3, 0.6);
  this->Mapper->GetLookupTable()->Modified();
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.01);
  this->Mapper->SetScalarModeToUseCellFieldData();
  this->Mapper->SelectColorArray("cells");
  this->Mapper->SetScalarRange(0.0, 6.0);
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.02);
  this->Mapper->SetScalarModeToUsePointFieldData();
  this->Mapper->SelectColorArray("direct");
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.02);
  // Color by component, and by the length of the vector.
  this->Mapper->SetColorModeToMapScalars();
  this->Mapper->GetLookupTable()->SetVectorModeToComponent();
  this->Mapper->SetScalarRange(0.0, 255.0);
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.02);
  this->Mapper->GetLookupTable()->SetVectorModeToMagnitude();
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball), 0.02);
}

TEST_F(PolyDataMapper, TexturesLookAsInVtk)
{
  const auto ball = MakeBall();
  ball->GetPointData()->SetActiveScalars(nullptr);
  vtkNew<vtkFloatArray> coordinates;
  coordinates->SetName("texture");
  coordinates->SetNumberOfComponents(2);
  for (vtkIdType point = 0; point < ball->GetNumberOfPoints(); ++point)
  {
    const double* place = ball->GetPoint(point);
    coordinates->InsertNextTuple2(3.0 * place[0], 2.0 * place[1] + 0.3);
  }
  ball->GetPointData()->SetTCoords(coordinates);
  vtkNew<vtkImageData> image;
  image->SetDimensions(16, 8, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < 8; ++y)
  {
    for (int x = 0; x < 16; ++x)
    {
      auto* texel = static_cast<unsigned char*>(image->GetScalarPointer(x, y, 0));
      texel[0] = static_cast<unsigned char>(16 * x);
      texel[1] = static_cast<unsigned char>(32 * y);
      texel[2] = (x + y) % 2 ? 200 : 0;
    }
  }
  vtkNew<vtkTexture> texture;
  texture->SetInputData(image);
  texture->InterpolateOn();
  this->Mapper->SetInputData(ball);
  this->Actor->SetTexture(texture);
  const Picture smooth = this->Render();
  texture->InterpolateOff();
  const Picture sharp = this->Render();
  EXPECT_FALSE(this->Building) << "the texture's settings";
  EXPECT_NE(smooth, sharp);
  ExpectAlike(sharp, this->RenderWithTriangles(ball), 0.03);
  texture->InterpolateOn();
  ExpectAlike(smooth, this->RenderWithTriangles(ball), 0.02);
  this->Actor->SetTexture(nullptr);
  ExpectAlike(this->Render(), this->RenderWithTriangles(ball));
}
