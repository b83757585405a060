// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMFileInformationHelper_h
#define vtkPVDSMFileInformationHelper_h

#include "vtkPVFileInformationHelper.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro

/// Before ParaView asks readers for a file (OpenDataFile), it asks the proxy ServerFileListing whether the file can be
/// read. Here, an address of a server may be, too.
class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMFileInformationHelper : public vtkPVFileInformationHelper
{
public:
  static vtkPVDSMFileInformationHelper* New();
  vtkTypeMacro(vtkPVDSMFileInformationHelper, vtkPVFileInformationHelper);

  bool GetActiveFileIsReadable();

protected:
  vtkPVDSMFileInformationHelper() = default;
  ~vtkPVDSMFileInformationHelper() override = default;

private:
  vtkPVDSMFileInformationHelper(const vtkPVDSMFileInformationHelper&) = delete;
  void operator=(const vtkPVDSMFileInformationHelper&) = delete;
};

#endif
