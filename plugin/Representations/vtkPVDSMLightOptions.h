// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMLightOptions
 * @brief   vtkDSMLightOptions, known to ParaView's client-server layer
 */

#ifndef vtkPVDSMLightOptions_h
#define vtkPVDSMLightOptions_h

#include "vtkDSMLightOptions.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMLightOptions : public vtkDSMLightOptions
{
public:
  static vtkPVDSMLightOptions* New();
  vtkTypeMacro(vtkPVDSMLightOptions, vtkDSMLightOptions);

  ///@{
  /**
   * As in the superclass; declared here because the client-server layer knows only the methods of
   * the plugin's own classes.
   */
  void SetShadows(bool shadows) override;
  void SetLightRadius(double radius) override;
  void SetAmbientOcclusionSamples(int samples) override;
  void SetAmbientOcclusionDistance(double distance) override;
  void SetEnvironmentLight(double strength) override;
  void SetReflectivity(double part) override;
  void SetMaxBounces(int bounces) override;
  void SetDebugView(int view) override;
  void SetShowLegend(bool show) override;
  void SetShowStatistics(bool show) override;
  ///@}

  /**
   * Of what nobody has chosen a look for: the settings page gives it one where there is a page; else it is plain.
   */
  static constexpr int AutomaticLook = 2;
  void SetLook(int look) override;

  /**
   * Samples of each pixel, rounded: ParaView's slider of choices is for floating point numbers only.
   */
  void SetSamples(double samples);

protected:
  vtkPVDSMLightOptions();
  ~vtkPVDSMLightOptions() override;

private:
  vtkPVDSMLightOptions(const vtkPVDSMLightOptions&) = delete;
  void operator=(const vtkPVDSMLightOptions&) = delete;
};

#endif
