// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMExportInformation
 * @brief   brings the surface that a representation shows from all ranks to the client
 *
 * For exporters, which write triangles. Gathered from one of our representations; first the size, then, if that is
 * wanted, the triangles.
 */

#ifndef vtkPVDSMExportInformation_h
#define vtkPVDSMExportInformation_h

#include "vtkPVInformation.h"
#include "vtkPolyData.h"                 // for ivars
#include "vtkRepresentationsDSMModule.h" // for the export macro
#include "vtkSmartPointer.h"             // for ivars

#include <vector> // for ivars

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMExportInformation : public vtkPVInformation
{
public:
  static vtkPVDSMExportInformation* New();
  vtkTypeMacro(vtkPVDSMExportInformation, vtkPVInformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * If true, gathers the triangles, not only their number. Off by default.
   */
  vtkSetMacro(WithTriangles, bool);
  vtkGetMacro(WithTriangles, bool);
  ///@}

  /**
   * Polygons of all ranks.
   */
  vtkGetMacro(NumberOfPolygons, vtkTypeInt64);

  /**
   * The triangles of all ranks, in the dataset's coordinates, with the arrays that color them; those that look alike
   * (vtkPVDSMExportLook) together.
   */
  std::vector<vtkSmartPointer<vtkPolyData>> GetTriangles() const;

  void CopyFromObject(vtkObject* representation) override;
  void AddInformation(vtkPVInformation* other) override;
  void CopyToStream(vtkClientServerStream* stream) override;
  void CopyFromStream(const vtkClientServerStream* stream) override;
  void CopyParametersToStream(vtkMultiProcessStream& stream) override;
  void CopyParametersFromStream(vtkMultiProcessStream& stream) override;

protected:
  vtkPVDSMExportInformation();
  ~vtkPVDSMExportInformation() override;

private:
  vtkPVDSMExportInformation(const vtkPVDSMExportInformation&) = delete;
  void operator=(const vtkPVDSMExportInformation&) = delete;

  bool WithTriangles = false;
  vtkTypeInt64 NumberOfPolygons = 0;
  std::vector<vtkSmartPointer<vtkPolyData>> Parts;
};

#endif
