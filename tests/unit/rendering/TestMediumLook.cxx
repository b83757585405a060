// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMTranslation.h"

#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <gtest/gtest.h>

namespace
{

/// vtkFixedPointVolumeRayCastMapper asks for the function of each volume that it draws.
TEST(MediumLook, GradientsAreNotLookedForWhereTheirOpacityIsOne)
{
  vtkNew<vtkVolumeProperty> property;
  EXPECT_EQ(vtkDSMTranslation::ToMediumLook(property, 0, 4.0).Gradients, nullptr);
  vtkPiecewiseFunction* const function = property->GetGradientOpacity();
  ASSERT_TRUE(property->HasGradientOpacity());
  EXPECT_EQ(vtkDSMTranslation::ToMediumLook(property, 0, 4.0).Gradients, nullptr);
  function->AddPoint(0.0, 0.5);
  const auto gradients = vtkDSMTranslation::ToMediumLook(property, 0, 4.0).Gradients;
  ASSERT_NE(gradients, nullptr);
  EXPECT_EQ(gradients->Last, 1.0);
  EXPECT_NEAR(gradients->GetFactor(0.0), 0.5, 1e-6);
}

} // namespace
