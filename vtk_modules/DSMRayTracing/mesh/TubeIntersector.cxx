// SPDX-License-Identifier: BSD-3-Clause
#include "DSMRayTracing/mesh/TubeIntersector.h"

#include "DSMRayTracing/mesh/RoundCone.h"

#include <algorithm>

namespace rt
{

namespace
{

/// Keeps the nearest of the places that count.
class TubeHits
{
public:
  TubeHits(
    const TriangleRay& ray, const MeshCulling& culling, double tPerUnit, TriangleHit& nearest)
    : Ray(ray)
    , Culling(culling)
    , TPerUnit(tPerUnit)
    , Nearest(nearest)
  {
  }

  /// Adds the ends of `span`, those inside `other` left out, whose balls `isOwn` accepts. `first` and `second`: the
  /// corners between which the balls are.
  template <class IsOwn>
  void Add(const ConeSpan& span, const ConeSpan& other, int first, int second, const IsOwn& isOwn)
  {
    if (span.Found)
    {
      for (const bool front : { true, false })
      {
        const double place = front ? span.Enter : span.Leave;
        const double ball = front ? span.EnterBall : span.LeaveBall;
        const bool isInside = other.Found && other.Enter < place && place < other.Leave;
        if (isOwn(ball) && !isInside && !(front ? this->Culling.Front : this->Culling.Back))
        {
          this->Take(place * this->TPerUnit, front, ball, first, second);
        }
      }
    }
  }

  bool IsFound() const { return this->Found; }

private:
  void Take(double t, bool front, double ball, int first, int second)
  {
    if (t >= this->Ray.Min && (this->Found ? t < this->Nearest.T : t <= this->Ray.Max))
    {
      this->Found = true;
      this->Nearest.T = t;
      this->Nearest.Front = front;
      std::fill_n(this->Nearest.Weights, 3, 0.0);
      this->Nearest.Weights[first] = 1.0 - ball;
      this->Nearest.Weights[second] += ball;
    }
  }

  const TriangleRay& Ray;
  const MeshCulling& Culling;
  double TPerUnit;
  TriangleHit& Nearest;
  bool Found = false;
};

} // namespace

bool IntersectTube(const TriangleRay& ray, const MeshCulling& culling,
  const bricks::TriangleBrickVertex& before, const bricks::TriangleBrickVertex& middle,
  const bricks::TriangleBrickVertex& behind, TriangleHit& hit)
{
  const BallRay line(ray);
  TubeHits hits(ray, culling, line.TPerUnit, hit);
  const auto isAny = [](double) { return true; };
  if (&before == &behind)
  {
    ConeSpan span;
    if (&before == &middle)
    {
      span.AddBall(line, middle, 0.0);
    }
    else
    {
      span = IntersectRoundCone(line, before, middle);
    }
    hits.Add(span, ConeSpan(), 0, 1, isAny);
  }
  else
  {
    ConeSpan to;
    ConeSpan from;
    if (&before != &middle)
    {
      to = IntersectRoundCone(line, before, middle);
    }
    if (&middle != &behind)
    {
      from = IntersectRoundCone(line, middle, behind);
    }
    // The middle of a cone is the one point's or the other's, and never both.
    constexpr double half = 0.5;
    hits.Add(to, from, 0, 1, [](double ball) { return ball >= half; });
    hits.Add(from, to, 1, 2, [](double ball) { return ball < half; });
  }
  const bricks::TriangleBrickVertex* const corners[3] = { &before, &middle, &behind };
  for (int corner = 0; corner < 3 && hits.IsFound(); ++corner)
  {
    std::copy_n(corners[corner]->Position, 3, hit.Corners[corner]);
  }
  return hits.IsFound();
}

} // namespace rt
