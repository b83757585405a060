// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMVolumeReader
 * @brief   image data, or a rectilinear grid, whose values stay in their file and are read on demand
 *
 * The output is a vtkRectilinearGrid (GetOutputDataObject(0)) where the file's coordinates are not evenly spaced.
 * Reads HDF5 (VTK's own ImageData, or any dataset of three axes), Zarr and OME-Zarr, NRRD, MetaImage and bare
 * values. It reads no values when it executes, except once for the arrays' ranges, which are kept in the user's
 * cache directory. The arrays of its output (vtkDSMFileArray) read the values that filters and mappers request. The
 * values that were read last stay in a cache that all readers of the process share. Ranks that ask for different
 * pieces get those.
 */

#ifndef vtkDSMVolumeReader_h
#define vtkDSMVolumeReader_h

#include "vtkImageAlgorithm.h"
#include "vtkNew.h"                // for ivars
#include "vtkRenderingDSMModule.h" // for the export macro

#include <functional> // for parameters
#include <memory>     // for ivars
#include <string>     // for ivars
#include <vector>     // for ivars

class vtkDataArraySelection;
class vtkDataSet;
namespace vol
{
struct FileArray;
struct OpenOptions;
}

class VTKRENDERINGDSM_EXPORT vtkDSMVolumeReader : public vtkImageAlgorithm
{
public:
  static vtkDSMVolumeReader* New();
  vtkTypeMacro(vtkDSMVolumeReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file; for Zarr, its folder, a file of metadata in it, or its address on a server. Several files are time steps,
   * in the order in which they are added; all must have the same arrays, samples and chunks. GetFileName returns the
   * first.
   */
  virtual void SetFileName(const char* name);
  virtual void AddFileName(const char* name);
  virtual void RemoveAllFileNames();
  const char* GetFileName() const;
  int GetNumberOfFileNames() const;
  ///@}

  /**
   * Returns whether a file looks like one of the supported formats.
   */
  virtual int CanReadFile(const char* name);

  /**
   * Returns whether a name is an address of a server, such as "https://host/image.zarr", and not a path. Only Zarr is
   * read from servers.
   */
  static bool IsAddress(const char* name);

  ///@{
  /**
   * The arrays to read; all by default.
   */
  virtual vtkDataArraySelection* GetPointDataArraySelection();
  virtual vtkDataArraySelection* GetCellDataArraySelection();
  ///@}

  ///@{
  /**
   * Level of detail to read, in a file with several: 0 (the default) is the finest.
   */
  vtkSetMacro(Level, int);
  vtkGetMacro(Level, int);
  ///@}

  /**
   * The file's levels of detail, each in a line with the points along x, y and z, such as "1: 256 x 256 x 128".
   * Opens levels that are not open yet; empty if the file cannot be opened.
   */
  virtual const char* GetLevelNames();

  ///@{
  /**
   * Dataset to read from an HDF5 file that is not VTK's. Empty (the default): all datasets that have the largest
   * shape of three axes in the file.
   */
  vtkSetMacro(DatasetName, std::string);
  vtkGetMacro(DatasetName, std::string);
  ///@}

  ///@{
  /**
   * Distance of samples along x, y and z, which replaces the file's; 0 (the default) keeps the file's. If OwnOrigin
   * is true (false by default), Origin replaces the position of the first sample, likewise.
   */
  vtkSetVector3Macro(Spacing, double);
  vtkGetVector3Macro(Spacing, double);
  vtkSetVector3Macro(Origin, double);
  vtkGetVector3Macro(Origin, double);
  vtkSetMacro(OwnOrigin, bool);
  vtkGetMacro(OwnOrigin, bool);
  vtkBooleanMacro(OwnOrigin, bool);
  ///@}

  ///@{
  /**
   * GetRawFile returns whether the file has bare values (.raw). The others describe these: samples along each axis,
   * their type (VTK_FLOAT and so on) and number of components, the order of bytes (RawBigEndian), bytes before the
   * first value, and the distance of samples, unless Spacing has it.
   */
  virtual bool GetRawFile();
  vtkSetVector3Macro(RawDimensions, int);
  vtkGetVector3Macro(RawDimensions, int);
  vtkSetMacro(RawScalarType, int);
  vtkGetMacro(RawScalarType, int);
  vtkSetMacro(RawComponents, int);
  vtkGetMacro(RawComponents, int);
  vtkSetMacro(RawBigEndian, bool);
  vtkGetMacro(RawBigEndian, bool);
  vtkSetMacro(RawHeaderBytes, vtkIdType);
  vtkGetMacro(RawHeaderBytes, vtkIdType);
  vtkSetVector3Macro(RawSpacing, double);
  vtkGetVector3Macro(RawSpacing, double);
  ///@}

  ///@{
  /**
   * If true, the output has ordinary arrays, each read entirely; false by default. Before VTK 9.4,
   * vtkTemporalStatistics needs it: it silently adds up the steps of other arrays wrongly. It is an error if an
   * array takes more than half of the host's available memory.
   */
  vtkSetMacro(ValuesInMemory, bool);
  vtkGetMacro(ValuesInMemory, bool);
  vtkBooleanMacro(ValuesInMemory, bool);
  ///@}

  ///@{
  /**
   * Limit in MiB of the values of files that stay in memory, in the whole process; 128 by default. While a file is
   * traced, the limit is raised to the chunks that eight bricks need together, up to an eighth of the memory. If
   * the chunks of four bricks exceed that, it is raised to these, up to half of the memory.
   */
  static void SetCacheMebibytes(int size);
  static int GetCacheMebibytes();
  ///@}

  /**
   * Returns the bytes of values that were read from files so far, in the whole process, without those for ranges.
   */
  static vtkTypeUInt64 GetBytesRead();

protected:
  vtkDSMVolumeReader();
  ~vtkDSMVolumeReader() override;

  int FillOutputPortInformation(int port, vtkInformation* information) override;
  int ProcessRequest(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override;
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override;

private:
  vtkDSMVolumeReader(const vtkDSMVolumeReader&) = delete;
  void operator=(const vtkDSMVolumeReader&) = delete;

  class Internals;
  /// Calls `work`. Returns 0 when it throws: the error is reported, once for each state of the reader, and the
  /// executive, which would report that there was one, is silent.
  int Attempt(const char* doing, const std::function<void()>& work);
  vol::OpenOptions GetOptions() const;
  void Open();
  /// Warns of bytes behind the values of a bare file: what was entered may be wrong.
  void TellOfRest() const;
  /// The extent, the place in the world, the scalars and the time steps of the open file.
  void TellOfFile(vtkInformation* information) const;
  /// Returns whether the file can be opened by now: what describes bare values must be there. Opens it. Throws
  /// dsm::Error.
  bool OpenIfDescribed();
  /// Makes the output an image or a rectilinear grid.
  void CreateOutput(vtkInformation* information);
  /// Sets the extent and the place of an image or a rectilinear grid.
  void PlaceGrid(vtkDataSet* grid, const int extent[6]) const;
  /// Fills it with the requested part of the open file. Throws dsm::Error.
  void FillGrid(vtkDataSet* grid, vtkInformation* information);
  bool IsChosen(const vol::FileArray& array) const;
  /// The image's: the first chosen array of points that has one component, or else the first one. Null: there is none.
  const vol::FileArray* FindScalars() const;
  /// The type of the scalars: filters of images make room by it before the values are there.
  void TellOfScalars(vtkInformation* information) const;
  void AddArrays(vtkDataSet* grid, const int extent[6], int step, bool isShare);

  std::vector<std::string> FileNames;
  int Level = 0;
  std::string DatasetName;
  double Spacing[3] = { 0.0, 0.0, 0.0 };
  double Origin[3] = { 0.0, 0.0, 0.0 };
  bool OwnOrigin = false;
  int RawDimensions[3] = { 0, 0, 0 };
  int RawScalarType;
  int RawComponents = 1;
  bool RawBigEndian = false;
  vtkIdType RawHeaderBytes = 0;
  double RawSpacing[3] = { 1.0, 1.0, 1.0 };
  bool ValuesInMemory = false;
  vtkNew<vtkDataArraySelection> PointArrays;
  vtkNew<vtkDataArraySelection> CellArrays;
  std::unique_ptr<Internals> Self;
};

#endif
