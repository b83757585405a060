// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMImageCompressor_h
#define vtkPVDSMImageCompressor_h

#include "vtkLZ4Compressor.h"
#include "vtkNew.h"

class vtkPVRenderView;
class vtkUnsignedCharArray;

/// Compresses the pictures that a server sends to its client, without losses, in place of ParaView's LZ4: by
/// Zstandard, after a prediction. Each pixel is like the one below it, or like that of the picture before, of which
/// only some tiles may have changed. The server sends the difference. One thread.
class vtkPVDSMImageCompressor : public vtkLZ4Compressor
{
public:
  static vtkPVDSMImageCompressor* New();
  vtkTypeMacro(vtkPVDSMImageCompressor, vtkLZ4Compressor);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Returns whether it was built with Zstandard.
  static bool IsAvailable();

  /// Local, on a client, and then on its server: takes the place of ParaView's LZ4 compressor in a view, with its
  /// configuration. Other compressors, which the user may have chosen, stay.
  static void Use(vtkPVRenderView* view);

  /// Pixels of the next picture; sent before it.
  void SetImageResolution(int width, int height) override;
  /// Input: pixels, by rows. Output: what Decompress takes; with several clients, what ParaView's compressor makes.
  /// Returns VTK_OK or VTK_ERROR.
  int Compress() override;
  /// Input: what Compress or ParaView's LZ4 compressor made. Output: pixels, of the size that is set. Returns VTK_OK or
  /// VTK_ERROR.
  int Decompress() override;

private:
  vtkPVDSMImageCompressor();
  ~vtkPVDSMImageCompressor() override;

  vtkIdType Width = 0;
  vtkNew<vtkUnsignedCharArray> Difference;
  vtkNew<vtkUnsignedCharArray> Last; ///< the picture before, which both sides have; or empty
};

#endif
