// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkDSMFileArray
 * @brief   an array whose values are in a file, and are read on demand
 *
 * Every filter that asks for values one by one, or tuple by tuple, works, and reads only the chunks that it needs;
 * they stay in a cache that all such arrays share. A filter that asks for the memory of the values (GetVoidPointer)
 * gets a copy of all of them when that takes at most half of what the host has left; else an error says so, and the
 * filter sees zeros. Values cannot be set. Reading is safe from any thread. A failure to read is reported once, and
 * the values are NaN, or zero.
 */

#ifndef vtkDSMFileArray_h
#define vtkDSMFileArray_h

#include "vtkDSMCompatibility.h"
#include "vtkDSMFileValues.h"

#include "vtkGenericDataArray.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

template <class ValueTypeT>
class vtkDSMFileArray : public vtkGenericDataArray<vtkDSMFileArray<ValueTypeT>, ValueTypeT>
{
  using GenericDataArrayType = vtkGenericDataArray<vtkDSMFileArray<ValueTypeT>, ValueTypeT>;

public:
  using SelfType = vtkDSMFileArray<ValueTypeT>;
  vtkAbstractTemplateTypeMacro(SelfType, GenericDataArrayType);
  using ValueType = ValueTypeT;

  static vtkDSMFileArray* New();

  /// Before anything else; the values are of ValueTypeT.
  void SetValues(std::shared_ptr<const vtkDSMFileValues> values);
  const vtkDSMFileValues& GetFileValues() const { return *this->Values; }

  ///@{
  /// Interface of vtkGenericDataArray.
  ValueType GetValue(vtkIdType index) const
  {
    return this->GetTypedComponent(
      index / this->NumberOfComponents, static_cast<int>(index % this->NumberOfComponents));
  }
  void SetValue(vtkIdType, ValueType) { this->RefuseToWrite(); }
  void GetTypedTuple(vtkIdType tuple, ValueType* out) const;
  void SetTypedTuple(vtkIdType, const ValueType*) { this->RefuseToWrite(); }
  ValueType GetTypedComponent(vtkIdType tuple, int component) const;
  void SetTypedComponent(vtkIdType, int, ValueType) { this->RefuseToWrite(); }
  ///@}

  /// Iterates over a copy of all values, like GetVoidPointer.
  vtkArrayIterator* NewIterator() override;
  void* GetVoidPointer(vtkIdType index) override;
  void ExportToVoidPointer(void* out) override;
  /// Returns the size, in KiB, of the memory for this array alone.
  unsigned long GetActualMemorySize() const override;

protected:
  vtkDSMFileArray();
  ~vtkDSMFileArray() override;

  /// Others that are made like this one are ordinary arrays, of the class that VTK itself makes.
  vtkObjectBase* NewInstanceInternal() const override
  {
    return vtkDataArray::CreateDataArray(this->GetDataType());
  }

  bool AllocateTuples(vtkIdType) { return this->RefuseToWrite(); }
  bool ReallocateTuples(vtkIdType) { return this->RefuseToWrite(); }

  bool ComputeScalarRange(double* ranges) override;
  bool ComputeScalarRange(double* ranges, const unsigned char*, unsigned char) vtkDSMOverrideSince92
  {
    return this->ComputeScalarRange(ranges);
  }
  bool ComputeVectorRange(double range[2]) override;
  bool ComputeVectorRange(
    double range[2], const unsigned char*, unsigned char) vtkDSMOverrideSince92
  {
    return this->ComputeVectorRange(range);
  }
  bool ComputeFiniteScalarRange(double* ranges) override;
  bool ComputeFiniteScalarRange(
    double* ranges, const unsigned char*, unsigned char) vtkDSMOverrideSince92
  {
    return this->ComputeFiniteScalarRange(ranges);
  }
  bool ComputeFiniteVectorRange(double range[2]) override;
  bool ComputeFiniteVectorRange(
    double range[2], const unsigned char*, unsigned char) vtkDSMOverrideSince92
  {
    return this->ComputeFiniteVectorRange(range);
  }

private:
  vtkDSMFileArray(const vtkDSMFileArray&) = delete;
  void operator=(const vtkDSMFileArray&) = delete;

  class Zeros;

  bool RefuseToWrite();
  void Report(const std::string& what) const;
  /// Returns the components of a tuple; null when they cannot be read. The pointer is valid until
  /// the thread asks for a tuple of another array.
  const ValueType* Find(vtkIdType tuple) const;
  /// Null where they are not known.
  const vol::ValueRanges* FindRanges() const;

  std::shared_ptr<const vtkDSMFileValues> Values;
  std::uint64_t Number; ///< no other array has had it
  std::mutex CopyLock;  ///< guards Copy and NoValues
  std::vector<ValueType> Copy;
  std::unique_ptr<Zeros> NoValues; ///< in place of Copy
  mutable std::atomic<bool> Reported{ false };

  friend class vtkGenericDataArray<vtkDSMFileArray<ValueTypeT>, ValueTypeT>;
};

/// The values of an array that is a vtkDSMFileArray; else null.
const vtkDSMFileValues* vtkDSMGetFileValues(vtkAbstractArray* array);
/// The same for the points or cells of an image that has so many along each axis; null, too, if a filter has given
/// the array to an image of another shape: then a box of the image is not a box of the file.
const vtkDSMFileValues* vtkDSMGetFileValues(vtkAbstractArray* array, const bricks::Index3& size);

/// An array that shows them, of their type, with the file's name for it.
vtkSmartPointer<vtkDataArray> vtkDSMCreateFileArray(
  const std::shared_ptr<const vtkDSMFileValues>& values);
/// An ordinary array with all of them, which takes no more than half of what the host has left. Throws dsm::Error.
vtkSmartPointer<vtkDataArray> vtkDSMReadFileArray(const vtkDSMFileValues& values);
/// VTK's number (VTK_FLOAT and so on) for its type.
int vtkDSMGetFileArrayType(bricks::ScalarType type);

#endif
