// SPDX-License-Identifier: BSD-3-Clause
#ifndef rt_FrameAccumulation_h
#define rt_FrameAccumulation_h

#include "DSMRayTracing/frame/Frame.h"
#include "DSMRayTracing/frame/FrameEntry.h"
#include "DSMRayTracing/frame/FrameRenderer.h"
#include "DSMRayTracing/frame/FrameRequest.h"
#include "DSMRayTracing/scene/Scene.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <vector>

namespace rt
{

/// A frame that gets its samples in one or several renders: as long as it shows the same, samples are
/// added to those that are there. A render may be aborted (FrameRenderer::SetWatch) at any time; the next one continues
/// with the tiles and samples that are missing.
class FrameAccumulation
{
public:
  /// Ranks and resources that trace.
  struct Ranks
  {
    dsm::Messenger& Messenger;
    FrameRenderer& Renderer;
    dsm::BlockStore& Store;
  };

  /// How many samples a render adds.
  struct Pace
  {
    int Samples = 0; ///< that are added at first; 0: all
    bool GoesOn =
      false; ///< adds others to these, until it is aborted: as many as are there, each time
  };

  /// State of a rank before Trace, and its request: sent to all ranks. Plain, for messages.
  struct Offer
  {
    FrameEntry Entry;
    /// Digest of the frame that samples are added to; a rank may have lost it while others have
    /// not.
    std::uint64_t Digest;
    std::int64_t Samples;
    std::int64_t SamplesUnderWay;
    /// Digest and number of the frame whose first sample was aborted.
    std::uint64_t BegunDigest;
    std::uint32_t BegunNumber;
    // These must be equal on all ranks.
    std::int64_t Wanted;
    std::int64_t PaceSamples;
    std::int64_t GoesOn;
  };
  /// Local. Arguments as of Trace; the scene and the request may lack what the ranks agree on before Trace.
  Offer CreateOffer(dsm::BlockStore& store, const Scene& scene, const FrameRequest& request,
    int wanted, const Pace& pace) const;

  using Report = dsm::FunctionRef<std::vector<std::byte>(const Frame&)>;

  enum class Result
  {
    Nothing, ///< was missing
    Traced,
    Aborted ///< tiles or samples are missing; the next Trace goes on
  };

  /// Collective. `offers`: of all ranks, in rank order; when there is anything to trace, its first part takes no other
  /// agreement before. Traces the samples of the request that are missing to `wanted` for each pixel, or as
  /// many as the pace allows. `report`: see FrameRenderer::Records.
  /// Returns what came of it, the same on every rank. Throws dsm::Error on every rank; then there is nothing to add to.
  Result Trace(const Ranks& ranks, const std::vector<Offer>& offers, const Scene& scene,
    FrameRequest request, int wanted, const Pace& pace, Report report);

  /// The last frame of which all tiles were traced; some may have more samples than others.
  const Frame& GetFrame() const { return this->Traced; }
  /// The next one, as far as it was traced before it was aborted; without tiles if there is none.
  const Frame& GetBegun() const { return this->Begun; }

  /// Collective. The same frame, whose light is filtered (LightFilter); `worldToClip` as in its request, which asked
  /// for the channels. Throws dsm::Error on every rank.
  const Frame& FilterLight(const Ranks& ranks, const glm::dmat4& worldToClip);

  /// Returns whether the frame has all requested samples, or there is no frame; the same on every
  /// rank.
  bool IsComplete() const { return this->Samples >= this->Wanted && this->SamplesUnderWay == 0; }

  /// Returns the samples that each pixel has at least; 0 without a frame.
  int GetSamples() const { return this->Samples; }
  /// Returns the samples that some pixels have; 0 for a first sample that was aborted.
  int GetMostSamples() const { return this->Samples + this->SamplesUnderWay; }
  int GetWanted() const { return this->Wanted; }
  /// Returns the part of all samples that is there; of a first sample, the part of its tiles. 1 only for a frame that
  /// is complete.
  double GetPart() const;

  /// Returns the seconds for one sample of each pixel in the last render; 0 if unknown.
  /// `lastSeconds`: that the last samples took, on every rank the same.
  double GetSecondsPerPixel(double lastSeconds) const;
  /// Returns the pixels of the frame that was begun which are traced, on all ranks together.
  double CountBegunPixels() const;

  /// Starts again with the next frame; ranks begin with their current tiles.
  void Restart();
  /// The same without the tiles.
  void Clear();
  /// As Restart, of a frame that could not be traced now, but shall be: until it is, there is none that is complete.
  void Postpone();

private:
  bool IsSame(const std::vector<Offer>& offers, std::uint64_t digest) const;
  bool IsBegun(const std::vector<Offer>& offers, std::uint64_t digest) const;
  Result TraceOnce(const Ranks& ranks, const Scene& scene, FrameRequest request,
    const FrameRenderer::Records& records);
  int CountNext(const Pace& pace) const;

  Frame Traced;
  Frame Filtered;                ///< by FilterLight, the frame of that number
  Frame Begun;                   ///< aborted, or without tiles
  std::uint64_t BegunDigest = 0; ///< digest of its content
  int BegunSamples = 0;          ///< that its tiles have
  std::uint64_t Digest = 0; ///< digest of the frame's content; 0: another frame takes its place
  int Samples = 0;          ///< that it has; 0 when there is nothing to add to
  int SamplesUnderWay = 0;  ///< that some tiles have got already: their adding was aborted
  int LastSamples = 0;      ///< that were added last to each pixel; 0: to some of them
  int Wanted = 0;
};

} // namespace rt

#endif
