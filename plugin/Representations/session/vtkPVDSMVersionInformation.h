// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMVersionInformation
 * @brief   which version of the plugin a process has loaded
 *
 * To be gathered from a session, as ParaView's own information is. Its list of plugins knows the version
 * only of those that a configuration file names, not of those that were loaded by their path.
 */

#ifndef vtkPVDSMVersionInformation_h
#define vtkPVDSMVersionInformation_h

#include "vtkPVInformation.h"
#include "vtkRepresentationsDSMModule.h" // for export macro

#include <string> // for the version

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMVersionInformation : public vtkPVInformation
{
public:
  static vtkPVDSMVersionInformation* New();
  vtkTypeMacro(vtkPVDSMVersionInformation, vtkPVInformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Empty where the plugin is not loaded. All ranks of a server have the same.
   */
  const std::string& GetVersion() const { return this->Version; }

  /**
   * Takes the version in this process; the object does not matter.
   */
  void CopyFromObject(vtkObject* object) override;
  void AddInformation(vtkPVInformation* other) override;
  void CopyToStream(vtkClientServerStream* stream) override;
  void CopyFromStream(const vtkClientServerStream* stream) override;

protected:
  vtkPVDSMVersionInformation();
  ~vtkPVDSMVersionInformation() override;

private:
  vtkPVDSMVersionInformation(const vtkPVDSMVersionInformation&) = delete;
  void operator=(const vtkPVDSMVersionInformation&) = delete;

  std::string Version;
};

#endif
