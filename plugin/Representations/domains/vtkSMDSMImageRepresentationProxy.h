// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMDSMImageRepresentationProxy
 * @brief   keeps track of whether the isosurface array and the isovalue are automatic
 *
 * DSMIsoArrayAutomatic and DSMIsoValueAutomatic are on at first. When the panel, a script, an animation or a state
 * file sets DSMIsoArray or DSMIsoValue, ParaView notifies this proxy, which switches the one or the other off.
 * Values that this class sets itself leave them on, and the defaults of their domains switch them on again. If the
 * data no longer have an automatic array, another one replaces it before the view renders; vtkPVDSMIsovalueWatch
 * gives an automatic isovalue its number after the render.
 *
 * Another array whose number of components differs is shown by its magnitude, as ParaView colors by.
 *
 * ParaView restores state files in the order of the properties' names, and Python states in that of the definitions.
 * In both, the switch comes after what it is about. Undo, and other clients, set all as it was.
 *
 * The name is what ParaView makes of the element DSMImageRepresentationProxy.
 */

#ifndef vtkSMDSMImageRepresentationProxy_h
#define vtkSMDSMImageRepresentationProxy_h

#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSMDSMRepresentationProxy.h"

#include <functional> // for arguments

class VTKREPRESENTATIONSDSM_EXPORT vtkSMDSMImageRepresentationProxy
  : public vtkSMDSMRepresentationProxy
{
public:
  static vtkSMDSMImageRepresentationProxy* New();
  vtkTypeMacro(vtkSMDSMImageRepresentationProxy, vtkSMDSMRepresentationProxy);

  /**
   * Calls `choose`, which sets the array, the isovalue or what is shown of a proxy of this class, and switches on
   * that it is automatic.
   */
  static void SetAutomatic(vtkSMProperty* property, const std::function<void()>& choose);

  /**
   * Returns whether the data have any array that the isosurfaces may be of, and are not flat.
   */
  bool CanHaveIsosurfaces();

  /**
   * Returns whether isosurfaces are shown, and not the outer surface.
   */
  bool ShowsIsosurfaces();

  bool IsIsovalueAutomatic();
  /**
   * Makes the isovalue automatic until the user or a script sets it. Until the next render it has its domain's
   * default.
   */
  void SetIsovalueAutomatic();
  /**
   * Sets the number that an automatic isovalue has, on the servers, too, and not as a step for the user to undo.
   */
  void SetAutomaticIsovalue(double value);

  ///@{
  /**
   * Returns whether the user or a script has set the isovalue since the last render.
   */
  bool IsIsovalueNew() const { return this->IsNew; }
  void NoteRender() { this->IsNew = false; }
  ///@}

  void LoadState(const vtkSMMessage* message, vtkSMProxyLocator* locator) override;

protected:
  vtkSMDSMImageRepresentationProxy();
  ~vtkSMDSMImageRepresentationProxy() override;

  int ReadXMLAttributes(vtkSMSessionProxyManager* manager, vtkPVXMLElement* element) override;
  void SetPropertyModifiedFlag(const char* name, int flag) override;
  void ViewUpdated(vtkSMProxy* view) override;

private:
  vtkSMDSMImageRepresentationProxy(const vtkSMDSMImageRepresentationProxy&) = delete;
  void operator=(const vtkSMDSMImageRepresentationProxy&) = delete;

  /// Shows isosurfaces of data that had no array for them when their display was made. Returns whether it does.
  bool ChooseShown();
  /// The magnitude, or the only component, where their number is another. Returns whether it is.
  bool ChooseComponent();
  void TellRange();

  bool IsChoosing = false; ///< this class is changing properties
  bool IsLoading = false;  ///< all properties become what they were
  bool IsNew = false;
  bool IsShownAutomatic = false; ///< what is shown is the data's default
  int Components = 0;            ///< of the isosurface array; 0: unknown
};

#endif
