// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMSampleVolume
 * @brief   generates a volume of any size, each piece on its own rank
 *
 * Yields vtkImageData with one array on the points, by default the paper's x^2 + y^2 + z^2 + noise = C on [-1,
 * 1]^3. A sample depends on its index and on the volume's size only. So ranks that ask for different pieces get
 * parts of the same volume, bit for bit, and no rank needs more memory than its piece. The samples are computed by
 * all cores.
 */
#ifndef vtkDSMSampleVolume_h
#define vtkDSMSampleVolume_h

#include "vtkImageAlgorithm.h"
#include "vtkRenderingDSMModule.h" // for the export macro

class VTKRENDERINGDSM_EXPORT vtkDSMSampleVolume : public vtkImageAlgorithm
{
public:
  static vtkDSMSampleVolume* New();
  vtkTypeMacro(vtkDSMSampleVolume, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Kinds
  {
    SPHERE = 0,       ///< a noisy sphere, array "f"; isovalue 0.5 (32 for integer types)
    MIXING_LAYER = 1, ///< a turbulent mixing layer in [0, 255], array "entropy"; isovalue 100
  };
  ///@{
  /// Which volume; SPHERE by default.
  vtkSetClampMacro(Kind, int, SPHERE, MIXING_LAYER);
  vtkGetMacro(Kind, int);
  ///@}

  ///@{
  /// Number of samples on each axis, at least 2; 256 by default.
  vtkSetVector3Macro(Dimensions, int);
  vtkGetVector3Macro(Dimensions, int);
  ///@}

  ///@{
  /// VTK_FLOAT (the default), VTK_UNSIGNED_CHAR or any other numeric type of VTK.
  vtkSetMacro(ScalarType, int);
  vtkGetMacro(ScalarType, int);
  ///@}

protected:
  vtkDSMSampleVolume();
  ~vtkDSMSampleVolume() override;

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override;

private:
  vtkDSMSampleVolume(const vtkDSMSampleVolume&) = delete;
  void operator=(const vtkDSMSampleVolume&) = delete;

  /// The extent, the place in the world, and the scalars.
  void TellOfVolume(vtkInformation* information) const;
  /// The part that is asked for.
  void FillImage(vtkImageData* image, vtkInformation* information);

  int Kind = SPHERE;
  int Dimensions[3] = { 256, 256, 256 };
  int ScalarType;
};

#endif
