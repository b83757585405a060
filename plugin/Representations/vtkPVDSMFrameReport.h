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
#include "vtkSmartPointer.h"             // for ivars

#include <string> // for ivars

class vtkDSMStatistics;

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMFrameReport : public vtkObject
{
public:
  static vtkPVDSMFrameReport* New();
  vtkTypeMacro(vtkPVDSMFrameReport, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Where to read from; null when the representation is in no view.
   */
  void SetSource(vtkDSMStatistics* source);

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

protected:
  vtkPVDSMFrameReport();
  ~vtkPVDSMFrameReport() override;

private:
  vtkPVDSMFrameReport(const vtkPVDSMFrameReport&) = delete;
  void operator=(const vtkPVDSMFrameReport&) = delete;

  vtkSmartPointer<vtkDSMStatistics> Source;
  std::string Text;
};

#endif
