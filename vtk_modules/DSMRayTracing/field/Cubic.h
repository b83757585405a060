// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_Cubic_h
#define rt_Cubic_h

namespace rt
{

/// Values along a way, from 0 to 1: c[0] + c[1] s + c[2] s^2 + c[3] s^3.
struct Cubic
{
  double Coefficients[4];

  double Evaluate(double s) const
  {
    const double* c = this->Coefficients;
    return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
  }
  double EvaluateDerivative(double s) const
  {
    const double* c = this->Coefficients;
    return c[1] + s * (2.0 * c[2] + s * 3.0 * c[3]);
  }
  /// The mean from 0 to 1.
  double GetMean() const
  {
    const double* c = this->Coefficients;
    return c[0] + c[1] / 2.0 + c[2] / 3.0 + c[3] / 4.0;
  }
};

/// The places in (0, 1) where the derivative vanishes, ascending; returns how many.
int FindExtrema(const Cubic& cubic, double extrema[2]);

/// The first place s in [0, 1] where the cubic changes its side; values >= 0 are inside. Returns false when it does
/// not. `last`: the value at 1, which tells the side there: the same bits as at the begin of the way that follows.
///
/// A change between the two ends always yields a place, whatever rounding does in between. Two
/// changes are found through the extrema of the cubic (Marmitt et al. 2004, "Fast and accurate
/// ray-voxel intersection techniques for iso-surface ray tracing").
bool FindFirstCrossing(const Cubic& cubic, double last, double& s);

/// How often the cubic changes its side on the way: 0 to 3.
int CountCrossings(const Cubic& cubic, double last);

/// Returns whether FindFirstCrossing would find a crossing, without computing its position.
bool HasCrossing(const Cubic& cubic, double last);

} // namespace rt

#endif
