// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMVolumeWriter
 * @brief   writes image data in bricks, so that its first picture reads only what it shows
 *
 * The file is VTK's ImageData in HDF5 (VTKHDF), which other programs read, too, with chunks that fit bricks, a
 * checksum of each, and an index of what bricks hold (docs/files.md); dsm_convert writes the same. Every rank of
 * the controller writes its piece of the input: Write is collective. Rank 0 writes, and all ranks must see the
 * file's folder. A failure to write is an error on every rank, and leaves no file of that name. A conversion of
 * dsm_convert to the same name that can be resumed is not replaced: that is an error, too.
 *
 * All arrays of numbers are written, of points and of cells; which cells are blanked is not.
 */

#ifndef vtkDSMVolumeWriter_h
#define vtkDSMVolumeWriter_h

#include "vtkRenderingDSMModule.h" // for the export macro
#include "vtkSmartPointer.h"       // for ivars
#include "vtkWriter.h"

#include <string> // for ivars

namespace dsm
{
class Messenger;
}
class vtkMultiProcessController;

class VTKRENDERINGDSM_EXPORT vtkDSMVolumeWriter : public vtkWriter
{
public:
  static vtkDSMVolumeWriter* New();
  vtkTypeMacro(vtkDSMVolumeWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to write; one that is there is replaced when all is written.
   */
  virtual void SetFileName(const char* name);
  const char* GetFileName() const;
  ///@}

  enum
  {
    NONE = 0,
    DEFLATE = 1,
    ZSTANDARD = 2
  };

  ///@{
  /**
   * How chunks are compressed: NONE (the default), DEFLATE, which every HDF5 library reads, or ZSTANDARD, which is
   * smaller and faster, and which others read with HDF5's plugin for it.
   */
  virtual void SetCompression(int compression);
  int GetCompression() const { return this->Compression; }
  ///@}

  ///@{
  /**
   * If true, writes coarser levels beside the values, each with half the samples along each axis, until one is a
   * single brick. Off by default. vtkDSMVolumeReader has them as levels.
   */
  virtual void SetCoarserLevels(bool coarser);
  bool GetCoarserLevels() const { return this->CoarserLevels; }
  ///@}

  ///@{
  /**
   * The ranks that have pieces; the global controller by default. Null: this process alone.
   */
  virtual void SetController(vtkMultiProcessController* controller);
  vtkMultiProcessController* GetController() const;
  ///@}

  /**
   * Collective over the controller's ranks. Returns 0 when it failed.
   */
  int Write() override;

protected:
  vtkDSMVolumeWriter();
  ~vtkDSMVolumeWriter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output) override;
  void WriteData() override;

private:
  vtkDSMVolumeWriter(const vtkDSMVolumeWriter&) = delete;
  void operator=(const vtkDSMVolumeWriter&) = delete;

  /// Collective: no rank writes if one has no image. Throws dsm::Error.
  void Join(dsm::Messenger& messenger, bool hasImage);
  /// Collective. Throws dsm::Error.
  void WriteImage();

  std::string FileName;
  int Compression = NONE;
  bool CoarserLevels = false;
  bool HasJoined = false; ///< in this Write
  vtkSmartPointer<vtkMultiProcessController> Controller;
};

#endif
