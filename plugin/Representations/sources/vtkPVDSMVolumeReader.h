// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVDSMVolumeReader
 * @brief   vtkDSMVolumeReader, known to ParaView's client-server layer
 */

#ifndef vtkPVDSMVolumeReader_h
#define vtkPVDSMVolumeReader_h

#include "vtkDSMVolumeReader.h"
#include "vtkRepresentationsDSMModule.h" // for the export macro

class VTKREPRESENTATIONSDSM_EXPORT vtkPVDSMVolumeReader : public vtkDSMVolumeReader
{
public:
  static vtkPVDSMVolumeReader* New();
  vtkTypeMacro(vtkPVDSMVolumeReader, vtkDSMVolumeReader);

  ///@{
  /**
   * As in the superclass; declared here because the client-server layer knows only the methods of
   * the plugin's own classes.
   */
  void SetFileName(const char* name) override;
  void AddFileName(const char* name) override;
  void RemoveAllFileNames() override;
  int CanReadFile(const char* name) override;
  vtkDataArraySelection* GetPointDataArraySelection() override;
  vtkDataArraySelection* GetCellDataArraySelection() override;
  void SetLevel(int level) override;
  const char* GetLevelNames() override;
  void SetDatasetName(const char* name);
  bool GetRawFile() override;
  void SetRawDimensions(int i, int j, int k) override;
  void SetRawDimensions(const int dimensions[3]) override;
  void SetRawScalarType(int type) override;
  void SetRawComponents(int components) override;
  void SetRawBigEndian(bool isBigEndian) override;
  void SetRawHeaderBytes(vtkIdType bytes) override;
  void SetSpacing(double x, double y, double z) override;
  void SetSpacing(const double spacing[3]) override;
  void SetOrigin(double x, double y, double z) override;
  void SetOrigin(const double origin[3]) override;
  void SetOwnOrigin(bool isOwn) override;
  void SetRawSpacing(double x, double y, double z) override;
  void SetRawSpacing(const double spacing[3]) override;
  void SetValuesInMemory(bool areInMemory) override;
  ///@}

protected:
  vtkPVDSMVolumeReader();
  ~vtkPVDSMVolumeReader() override;

private:
  vtkPVDSMVolumeReader(const vtkPVDSMVolumeReader&) = delete;
  void operator=(const vtkPVDSMVolumeReader&) = delete;
};

#endif
