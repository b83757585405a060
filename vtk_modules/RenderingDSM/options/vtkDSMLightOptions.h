// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMLightOptions
 * @brief   how light travels to and from one dataset: shadows, ambient occlusion, mirrors, samples
 *
 * Held by each mapper of a vtkDSMScene. All objects of a scene are in one light, so of everything but
 * the reflectivity the strongest demand among the visible objects counts for the whole scene. Same
 * values on every rank. A pixel's random numbers depend on the pixel and the sample's number only,
 * so the picture is the same on any number of ranks.
 */

#ifndef vtkDSMLightOptions_h
#define vtkDSMLightOptions_h

#include "vtkObject.h"
#include "vtkRenderingDSMModule.h" // for the export macro

class VTKRENDERINGDSM_EXPORT vtkDSMLightOptions : public vtkObject
{
public:
  static vtkDSMLightOptions* New();
  vtkTypeMacro(vtkDSMLightOptions, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether surfaces cast shadows. Off by default. What is translucent dims and tints the light.
   */
  vtkSetMacro(Shadows, bool);
  vtkGetMacro(Shadows, bool);
  vtkBooleanMacro(Shadows, bool);
  ///@}

  ///@{
  /**
   * Apparent radius of every light, as the tangent of half the angle that it fills; 0 (the default)
   * gives hard shadows, 0.05 about ten times the sun's. Needs several samples per pixel.
   */
  vtkSetClampMacro(LightRadius, double, 0.0, 10.0);
  vtkGetMacro(LightRadius, double);
  ///@}

  ///@{
  /**
   * Rays that look for what is near, for each sample of a pixel; 0 (the default): none.
   */
  vtkSetClampMacro(AmbientOcclusionSamples, int, 0, 1024);
  vtkGetMacro(AmbientOcclusionSamples, int);
  ///@}

  ///@{
  /**
   * What is farther away, in world units, does not occlude; 0 (the default): a fifth of the diagonal
   * of what is shown.
   */
  vtkSetClampMacro(AmbientOcclusionDistance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(AmbientOcclusionDistance, double);
  ///@}

  ///@{
  /**
   * How a scene looks for which no shadows, ambient occlusion or environment light is set. PlainLook (the
   * default): as VTK draws it. DepthLook: the brightest light casts faint shadows in still pictures, by one more
   * ray for each sample.
   */
  enum LookType
  {
    PlainLook = 0,
    DepthLook = 1
  };
  vtkSetClampMacro(Look, int, PlainLook, DepthLook);
  vtkGetMacro(Look, int);
  ///@}

  ///@{
  /**
   * Light from all around, in the colours of the renderer's background: of a gradient, Background from
   * below and Background2 from above, as the renderer's EnvironmentUp has it; times this number. 0 (the
   * default): none. With ambient occlusion, what its rays meet keeps that light away.
   */
  vtkSetClampMacro(EnvironmentLight, double, 0.0, 100.0);
  vtkGetMacro(EnvironmentLight, double);
  ///@}

  ///@{
  /**
   * Part of the light that this dataset's surfaces mirror, 0 (the default) to 1.
   */
  vtkSetClampMacro(Reflectivity, double, 0.0, 1.0);
  vtkGetMacro(Reflectivity, double);
  ///@}

  ///@{
  /**
   * How often a ray may be mirrored. Default 2.
   */
  vtkSetClampMacro(MaxBounces, int, 0, 64);
  vtkGetMacro(MaxBounces, int);
  ///@}

  ///@{
  /**
   * Samples of each pixel in a still picture; more smooth edges, soft shadows and ambient occlusion.
   * Default 1.
   */
  vtkSetClampMacro(SamplesPerPixel, int, 1, 65536);
  vtkGetMacro(SamplesPerPixel, int);
  ///@}

  ///@{
  /**
   * What the surfaces' colours tell instead of their look. The first among a scene's visible objects
   * that is not Off counts. TracingRank, TileTime, NewTiles and Misses differ from frame to frame.
   */
  enum DebugViewType
  {
    Off = 0,
    Owner = 1,       ///< which rank owns the brick
    TracingRank = 2, ///< which rank traced the pixel
    Brick = 3,       ///< which brick it is
    TileTime = 4,    ///< how long the tile took: black, red, yellow, white (2 ms or more)
    Normal = 5,      ///< x, y, z as red, green, blue
    Depth = 6,       ///< near is bright
    NewTiles = 7,    ///< red: another rank traced the tile in the last frame
    Misses = 8       ///< bricks that the tile waited for: black, red, yellow, white (16 or more)
  };
  vtkSetClampMacro(DebugView, int, Off, Misses);
  vtkGetMacro(DebugView, int);
  ///@}

  ///@{
  /**
   * Whether a legend in the picture says what the colours of the debug view mean (the default), and
   * whether the figures of the frame are written into it (off by default).
   */
  vtkSetMacro(ShowLegend, bool);
  vtkGetMacro(ShowLegend, bool);
  vtkBooleanMacro(ShowLegend, bool);
  vtkSetMacro(ShowStatistics, bool);
  vtkGetMacro(ShowStatistics, bool);
  vtkBooleanMacro(ShowStatistics, bool);
  ///@}

protected:
  vtkDSMLightOptions();
  ~vtkDSMLightOptions() override;

private:
  vtkDSMLightOptions(const vtkDSMLightOptions&) = delete;
  void operator=(const vtkDSMLightOptions&) = delete;

  bool Shadows = false;
  double LightRadius = 0.0;
  int AmbientOcclusionSamples = 0;
  double AmbientOcclusionDistance = 0.0;
  int Look = PlainLook;
  double EnvironmentLight = 0.0;
  double Reflectivity = 0.0;
  int MaxBounces = 2;
  int SamplesPerPixel = 1;
  int DebugView = Off;
  bool ShowLegend = true;
  bool ShowStatistics = false;
};

#endif
