// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMFrameReport
 * @brief   tells the client what the ranks did for a view's last frame
 *
 * Lives on the servers only: information properties are read where their proxy lives, and a
 * representation also lives on the client, which has no scene.
 */

#ifndef vtkPVDSMFrameReport_h
#define vtkPVDSMFrameReport_h

#include "vtkObject.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkWeakPointer.h"              // for ivars

#include <string> // for ivars

class vtkDSMScene;
class vtkDSMVolumeMapper;
class vtkPVRenderView;

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMFrameReport : public vtkObject
{
public:
  static vtkPVDSMFrameReport* New();
  vtkTypeMacro(vtkPVDSMFrameReport, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Sets the view whose scene is read; null if the representation is in no view. A dataset has a representation for
   * each way in which it can be shown, and all of them report the same frames.
   */
  void SetView(vtkPVRenderView* view);

  /**
   * Sets the mapper whose isovalue is reported; null for a mesh.
   */
  void SetVolume(vtkDSMVolumeMapper* volume);

  /**
   * The isovalue that the data suggest; not a number where they suggest none.
   */
  double GetSuggestedIsoValue();

  /**
   * Range of the values without fills that nothing declares; not a number where there are none.
   */
  double* GetSuggestedRange() VTK_SIZEHINT(2);

  /**
   * Number of samples along each axis that slices may have the index of; zeros where there are no
   * slices.
   */
  int* GetSlicePoints() VTK_SIZEHINT(3);

  /**
   * Seconds the last frame took to trace; 0 without one.
   */
  double GetFrameTime();

  /**
   * Every rank's counters for the last frame, as JSON; see vtkDSMStatistics.
   */
  const char* GetStatistics();

  /**
   * The same in a few lines for the eye.
   */
  const char* GetSummary();

  /**
   * Samples of each pixel that the view's picture has, and those that were asked for; zeros without
   * a picture.
   */
  int* GetSamples() VTK_SIZEHINT(2);

  /**
   * Samples that each pixel of the view's picture has, those that were asked for, the part of all samples that is
   * there, 0 to 1, and 1 if the last render began another picture, else 0. A picture without data is whole.
   */
  double* GetRefinement() VTK_SIZEHINT(4);

  /**
   * Collective. Continues to trace the view's picture, without drawing, until it has all samples, or so many seconds
   * are over, or, after a moment, this process's client has sent something.
   */
  void Advance(double seconds);

  ///@{
  /**
   * If true, the client continues to render a still view until it is refined, so a render need not take all
   * samples. Off by default.
   */
  void SetProgressive(bool progressive);
  bool GetProgressive();
  ///@}

  ///@{
  /**
   * Set while the user moves the camera. Then no render need take all samples, even if its picture is kept: web
   * applications send such pictures to the browser, one after the other. Off by default.
   */
  void SetInteracting(bool interacting);
  bool GetInteracting();
  ///@}

  /**
   * Local: the view's pictures get to the client, which is prepared for it, in fewer bytes. Without effect in a process
   * that sends none.
   */
  void CompressPictures(bool compress);

protected:
  vtkPVDSMFrameReport();
  ~vtkPVDSMFrameReport() override;

private:
  vtkPVDSMFrameReport(const vtkPVDSMFrameReport&) = delete;
  void operator=(const vtkPVDSMFrameReport&) = delete;

  /// Null where there is none.
  vtkDSMScene* FindScene() const;

  vtkWeakPointer<vtkPVRenderView> View;
  vtkWeakPointer<vtkDSMVolumeMapper> Volume;
  bool Progressive = false;
  bool Interacting = false;
  int Samples[2] = { 0, 0 };
  double Refinement[4] = { 0.0, 0.0, 1.0, 0.0 };
  int SlicePoints[3] = { 0, 0, 0 };
  double Range[2] = { 0.0, 0.0 };
  std::string Text;
};

#endif
