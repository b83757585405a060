// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMScene
 * @brief   traces all volumes and actors of a renderer that have one of our mappers, once a frame
 *
 * One for each renderer. Observes the renderer's StartEvent with priority -1, after the camera has been
 * synchronized between the ranks. Then, on all ranks at once, it takes in data that changed, traces the frame, and
 * gives it to its vtkDSMFrameProp, which draws it when the renderer comes to it. Every rank that renders must hold
 * the scene, also one that has no data; a process that only displays (ParaView's client) must not.
 *
 * Usage: `vtkSmartPointer<vtkDSMScene> scene = vtkDSMScene::ForRenderer(renderer)`, kept for as long
 * as they shall be drawn; add vtkVolumes that have a vtkDSMVolumeMapper, and vtkActors that have a
 * vtkDSMPolyDataMapper, to the renderer as usual. Light and shadow go across all of them. In one process
 * the mappers make a scene where there is none, and the renderer keeps it.
 *
 * Failures are reported with vtkErrorMacro, once for each change of state or of the memory's settings, on every
 * rank; the picture then lacks what could not be drawn, and the application goes on.
 */

#ifndef vtkDSMScene_h
#define vtkDSMScene_h

#include "vtkNew.h" // for ivars
#include "vtkObject.h"
#include "vtkRenderingDSMModule.h" // for the export macro
#include "vtkSmartPointer.h"       // for ivars
#include "vtkWeakPointer.h"        // for ivars
#include "vtkWrappingHints.h"      // for VTK_NEWINSTANCE

#include <functional> // for a parameter
#include <memory>     // for ivars
#include <string>     // for ivars

class vtkAlgorithm;
class vtkCamera;
class vtkDSMFrameProp;
class vtkDSMLightOptions;
class vtkDSMStatistics;
class vtkImageData;
class vtkMultiBlockDataSet;
class vtkMultiProcessController;
class vtkRenderer;

class VTKRENDERINGDSM_EXPORT vtkDSMScene : public vtkObject
{
public:
  vtkTypeMacro(vtkDSMScene, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Returns the renderer's scene, and makes one if there is none. It lives as long as any reference to it.
   * NewForRenderer is for wrapped languages, whose callers have to delete the result: VTK 9.1 does not wrap smart
   * pointers. Null, with a warning, without a renderer.
   */
  VTK_WRAPEXCLUDE static vtkSmartPointer<vtkDSMScene> ForRenderer(vtkRenderer* renderer);
  /**
   * Returns the renderer's scene; null if there is none.
   */
  static vtkDSMScene* Find(vtkRenderer* renderer);
  VTK_NEWINSTANCE static vtkDSMScene* NewForRenderer(vtkRenderer* renderer);
  ///@}

  /**
   * For a mapper that has to draw in a renderer without a scene: makes a scene that ends with the renderer, and has
   * the frame drawn again at its end. With several processes this is an error, which is reported once for each
   * renderer: other ranks may not be drawing.
   */
  static void DrawWithoutScene(vtkRenderer* renderer, vtkObject* mapper);

  ///@{
  /**
   * The processes that render together; by default the global controller. Set before the first frame.
   */
  void SetController(vtkMultiProcessController* controller);
  vtkMultiProcessController* GetController() const;
  ///@}

  vtkRenderer* GetRenderer() const;

  /**
   * The light of everything that the scene shows; never null. Set the same values on every rank.
   */
  vtkDSMLightOptions* GetLightOptions() const;

  /**
   * Lets each rank draw the tiles that it traced, color and depth, for an application that composites by depth. The
   * default.
   */
  void DeliverTiles();

  /**
   * Lets every rank get the whole frame and draw it, for an application that shows one rank's window and composites
   * nothing. Same call on every rank.
   */
  void DeliverEverywhere();

  /**
   * Lets every rank get the whole frame and draw its depth. A rank draws color only if `drawsColor`, which is
   * called once a frame, returns true. For an application that blends the ranks' pictures in order: the farthest
   * rank draws the color, and the others hide objects behind it. Same call on every rank.
   */
  void DeliverEverywhere(std::function<bool(vtkCamera*)> drawsColor);

  /**
   * The same for an application in which each rank draws its own part of space. Translucent surfaces are drawn, one
   * by one, by the rank whose `drawsPlace` returns true for their place (world coordinates); exactly one rank must
   * return true. Then translucent surfaces of this scene and all other objects of the renderer are in the right
   * order. `drawsColor` applies to opaque surfaces.
   */
  void DeliverByPlace(std::function<bool(vtkCamera*)> drawsColor,
    std::function<bool(const double place[3])> drawsPlace);

  /**
   * Makes a picture without a window, and so without OpenGL, a display, a graphics card or EGL. It shows all props
   * of the renderer that have this module's mappers, from its active camera (clipping range included), with its
   * lights, or a headlight if it has none, and with all samples. `image` gets `width` x `height` points, row 0 the
   * lowest, with the scalars "color", 4 bytes, and the array "depth", a float as in a window's depth buffer, 1
   * where nothing is. If a volume has the blend mode vtkDSMVolumeMapper::INTEGRAL_BLEND, there also is the array
   * "integral", a float: the integral along the ray through the middle of the pixel, between the clipping planes
   * of the camera, whatever surfaces are there; of several such volumes the sum. Colors lie over the renderer's
   * background, or, if `transparent`, have the opacity of what is shown, and are not multiplied by it. Props with
   * other mappers are left out. The pixels are those that a window of this size shows; how the frame reaches
   * windows makes no difference. A renderer without a window needs no more than VTK's libraries.
   *
   * Collective: every rank calls it with the same size, also one that has no data. Each gets the whole picture,
   * unless its `image` is null. False, with an error as for a frame, if that fails; the same on every rank.
   */
  bool TraceImage(int width, int height, vtkImageData* image, bool transparent = false);

  ///@{
  /**
   * Makes the triangles of the isosurfaces that a mapper shows in the renderer, from the values that pictures are
   * traced from. So they lie where the picture has surfaces, also around missing values, on any number of ranks.
   * `surfaces`, which is empty, gets a vtkPolyData for each image, block of AMR or hyper tree grid of this rank,
   * with the triangles in its own cells, ghost cells excluded, in the data's coordinates. Their cells have
   * vtkOriginalCellIds, and their points vtkOriginalPointIds, the nearest points of the dataset (of a hyper tree
   * grid: -1); of a composite dataset, both have vtkCompositeIndex. For exports they have normals and the array
   * that colors the surface: as in the dataset, or, for AMR and hyper tree grids, the mapped component at the
   * points.
   *
   * Where levels of AMR or trees meet, triangles of both sides may leave narrow gaps. For selections, hyper tree
   * grids have no triangles: VTK extracts none of their cells.
   *
   * Collective, between frames. Returns false, with an error on every rank, if that fails, or if any rank would
   * have more than MostTriangles, or, for a selection, an image more than MostCellsOfSelection cells: ParaView
   * takes 10 bytes or more for each of its cells.
   */
  bool ExtractIsosurfaces(vtkAlgorithm* mapper, bool forSelection, vtkMultiBlockDataSet* surfaces);
  static constexpr vtkIdType MostTriangles = 10'000'000;
  static constexpr vtkIdType MostCellsOfSelection = vtkIdType(1) << 27;
  ///@}

  /**
   * A hidden scene neither traces nor draws, and keeps its data: for renders that the user does not see, such as
   * those of a selection. Same value on every rank.
   */
  void SetHidden(bool hidden);

  /**
   * Leaves the last frame out of the renderer's bounds until the next frame. A camera that is reset before shows what
   * is visible now, and not what was. For applications that gather the bounds of all ranks' objects, as ParaView does
   * in each update. Local, between frames.
   */
  void ForgetFrameBounds();

  ///@{
  /**
   * Number of samples of each pixel that one render adds to the picture while camera, data and look do not change,
   * until it has the number of GetLightOptions(); 0 (the default): all at once. An interactive application takes 1,
   * and renders again while IsRefined() is false. While the window wants interactive rates (its DesiredUpdateRate
   * is 1 or more), it is 1. Same value on every rank.
   */
  void SetSamplesPerFrame(int samples);
  int GetSamplesPerFrame() const;
  ///@}

  ///@{
  /**
   * Time in seconds after which tracing ends, whatever is missing, if SamplesPerFrame is positive or the window wants
   * interactive rates. Tiles that are not ready show the last picture, moved as the camera has. A render, or Advance,
   * continues with them. If there is time left, a still picture gets more samples than SamplesPerFrame. A first
   * picture, and one of data that take the place of others, such as time steps, takes the time that it needs. 0 (the
   * default): no limit. Same value on every rank.
   */
  void SetSecondsPerFrame(double seconds);
  double GetSecondsPerFrame() const;
  ///@}

  ///@{
  /**
   * While the window wants interactive rates, one pixel is traced for a square of pixels, which it fills. The
   * square has this edge at least, and up to 16 if the frame would take longer than about 0.05 s, by the time of the
   * last one. 0 (the default): every pixel is traced. Same value on every rank.
   */
  void SetInteractiveReduction(int edge);
  int GetInteractiveReduction() const;
  ///@}

  ///@{
  /**
   * Treats renders as if the window wanted interactive rates. Off by default. Same value on every rank.
   */
  void SetInteracting(bool interacting);
  bool GetInteracting() const;
  ///@}

  ///@{
  /**
   * If a still picture of a new look or camera would take longer than about 0.2 s, a draft is shown first, with up to
   * 8 x 8 pixels in one. Further renders replace it, as long as IsRefined() is false. Data that take the place of
   * others, such as time steps, have no draft. Has no effect unless SamplesPerFrame is positive. Off by default. Same
   * value on every rank.
   */
  void SetShowsDrafts(bool drafts);
  bool GetShowsDrafts() const;
  ///@}

  ///@{
  /**
   * Traces every frame from the finest data, also while the window wants interactive rates and vtkDSMMemoryOptions
   * lets coarser ones stand in: for pictures that are kept. Off by default. Same value on every rank.
   */
  void SetAlwaysFinest(bool finest);
  bool GetAlwaysFinest() const;
  ///@}

  /**
   * Each rank's window is one of columns x rows tiles of a display, of the same size, with gaps of so many
   * pixels between them. The frame is traced for the whole display; the application draws each tile with
   * its part of the projection. 1 x 1 (the default): each window shows all. Same values on every rank.
   */
  void SetTileDisplay(int columns, int rows, int gapX = 0, int gapY = 0);

  /**
   * Continues with the picture that was drawn last, without drawing: the next render shows what has come. On rank 0,
   * `goesOn` is called again and again, and returns false to end this; other ranks pass any function. Ends, too, when
   * the picture is refined. Does nothing if there is something else to draw. Returns whether it could go on; false,
   * with an error as for a frame, if that fails.
   *
   * Collective, between frames.
   */
  VTK_WRAPEXCLUDE bool Advance(std::function<bool()> goesOn);

  /**
   * Returns whether the last picture has all the samples that were asked for; the same on every rank. False, too,
   * after a render that was aborted: while it traces, the window of rank 0 is asked for its abort status
   * (vtkRenderWindow::CheckAbortStatus, AbortCheckEvent), and then all ranks keep the last picture. The next
   * render continues with the tiles and samples of this one.
   */
  bool IsRefined() const;

  /**
   * Returns whether the last render began a picture: the scene or the camera had changed. The same on every rank.
   */
  bool HasBegun() const;

  /**
   * Returns the part of the picture's samples that is there, 0 to 1; of a first sample, the part of its tiles. Drafts
   * do not count. The same on every rank.
   */
  double GetRefinedPart() const;

  /**
   * Returns the number of samples of each pixel in the last picture; 0 without one. The same on every rank.
   */
  int GetNumberOfSamples() const;

  /**
   * Returns the number of samples of each pixel that the objects of the last picture request; 0 without one.
   */
  int GetNumberOfSamplesWanted() const;

  /**
   * Returns whether a frame is being made: from taking in data, whose progress the mappers report, to the last
   * tile.
   */
  bool IsTracing() const;

  /**
   * Returns the statistics of the last frame; the same on every rank.
   */
  vtkDSMStatistics* GetStatistics() const;

protected:
  vtkDSMScene();
  ~vtkDSMScene() override;

private:
  vtkDSMScene(const vtkDSMScene&) = delete;
  void operator=(const vtkDSMScene&) = delete;

  static vtkDSMScene* New();
  void Attach(vtkRenderer* renderer);
  void EndWithRenderer();
  void NoteBackground();
  void Trace();
  bool TraceFrame();
  bool FillWithBackground();
  void EndFrame();
  void EndReading();

  class Internals;
  std::unique_ptr<Internals> Self;
};

#endif
