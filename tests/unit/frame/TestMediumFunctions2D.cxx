// SPDX-License-Identifier: BSD-3-Clause
// Media of a function of the value and of a second number.
#include "tests/unit/frame/MediumIntegral.h"

namespace
{

/// Blobs of several colors, one of them at the image's edge, and a box with hard edges.
rt::TransferFunction2D::Image MakeImage()
{
  rt::TransferFunction2D::Image image;
  image.Columns = 20;
  image.Rows = 14;
  image.Values = { -2.5, 2.0 };
  image.Seconds = { 0.0, 0.8 };
  const auto blob = [](double x, double y) { return std::max(0.0, 1.0 - 0.1 * (x * x + y * y)); };
  for (int row = 0; row < image.Rows; ++row)
  {
    for (int column = 0; column < image.Columns; ++column)
    {
      glm::dvec4 look(0.0);
      look += blob(column - 4.0, row - 9.0) * glm::dvec4(0.9, 0.2, 0.1, 0.6);
      look += blob(column - 19.0, row - 1.0) * glm::dvec4(0.1, 0.3, 0.9, 0.8);
      look += column > 9 && column < 13 && row > 4 && row < 8 ? glm::dvec4(0.2, 0.9, 0.3, 0.97)
                                                              : glm::dvec4(0.0);
      image.Looks.push_back(look);
    }
  }
  return image;
}

double GetExtinction(double opacity)
{
  return -std::log1p(-opacity) / 0.2;
}

class TestMediumFunctions2D : public TestMediumIntegral
{
protected:
  /// Of 255, at single pixels: edges of the function are hard.
  static constexpr double MostOff = 3.0;

  TestMediumFunctions2D() { this->StepsInCell = 64.0; }

  static double GetSecond(const glm::dvec3& p)
  {
    return 0.4 + 0.3 * std::sin(4.0 * p.y - 3.0 * p.z) * std::cos(5.0 * p.x);
  }
};

TEST_F(TestMediumFunctions2D, OfGradients)
{
  this->Add2D(GetWaves, nullptr, MakeImage(), GetExtinction);
  EXPECT_LT(this->Compare(GetPerspective()), MostOff);
  EXPECT_LT(this->Compare(GetAlongZ()), MostOff);
}

TEST_F(TestMediumFunctions2D, OfAnotherArray)
{
  this->Add2D(GetWaves, GetSecond, MakeImage(), GetExtinction);
  EXPECT_LT(this->Compare(GetPerspective()), MostOff);
  EXPECT_LT(this->Compare(GetAlongZ()), MostOff);
}

TEST_F(TestMediumFunctions2D, OfNoise)
{
  this->Add2D(GetNoise, GetSecond, MakeImage(), GetExtinction);
  EXPECT_LT(this->Compare(GetPerspective()), MostOff);
}

TEST_F(TestMediumFunctions2D, InAnotherMedium)
{
  this->Add2D(GetWaves, GetSecond, MakeImage(), GetExtinction);
  this->Add([](const glm::dvec3& p) { return 2.0 - 3.0 * glm::length(p); },
    { { -3.0, { 0.1, 0.3, 0.9, 0.0 } }, { 3.0, { 0.9, 0.2, 0.1, 6.0 } } });
  EXPECT_LT(this->Compare(GetPerspective()), MostOff);
}

/// Rows that are the same are a function of the values alone.
TEST_F(TestMediumFunctions2D, ThatIsOneOfTheValuesIsAsThatIs)
{
  rt::TransferFunction2D::Image image;
  image.Columns = 2;
  image.Values = { -6.0, 6.0 };
  image.Looks = { { 0.1, 0.3, 0.9, 0.0 }, { 0.9, 0.2, 0.1, 6.0 } };
  const auto getExtinction = [](double depth) { return depth; };
  const rt::TransferFunction2D function(image, getExtinction, 0.1);
  const rt::TransferFunction& envelope = *function.GetEnvelope();
  EXPECT_FALSE(envelope.IsSeen(-9.0, -3.0));
  EXPECT_TRUE(envelope.IsSeen(-9.0, -2.9));
  for (const double begin : { -9.0, -2.0, 0.5, 4.0 })
  {
    for (const double end : { begin, begin + 0.3, begin - 8.0 })
    {
      const double places[2] = { envelope.GetPlace(begin), envelope.GetPlace(end) };
      constexpr double length = 1e-6;
      const double middle = 0.5 * (places[0] + places[1]);
      const rt::Lanes found =
        function.GetAmount({ places[0], 3.0 }, { middle, -30.0 }, { places[1], -70.0 }, length);
      rt::Lanes slope;
      const rt::Lanes first = envelope.Integrate(places[0], slope);
      const rt::Lanes expected = begin == end
        ? slope
        : (envelope.Integrate(places[1], slope) - first) * rt::Lanes(1.0 / (places[1] - places[0]));
      for (int channel = 0; channel < 4; ++channel)
      {
        EXPECT_NEAR(found[channel] / length, expected[channel], 1e-4) << begin << ", " << end;
      }
    }
  }
}

} // namespace
