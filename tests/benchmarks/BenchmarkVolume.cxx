// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkVolume.h"

#include "BenchmarkFile.h"

#include "DSMBricks/build/PublishVolume.h"
#include "DSMBricks/sample/SampleVolume.h"
#include "DSMVolumeFiles/open/OpenVolumeFile.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkXMLImageDataReader.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>
#include <thread>

namespace
{

/// A whole volume, before it is cut: what it is made of and how to get a box of its cells.
struct Input
{
  bricks::Index3 Points;
  bricks::ScalarType Type;
  glm::dmat4 IndexToWorld{ 1.0 };
  std::shared_ptr<const bricks::GridPlanes> Planes;
  std::function<std::shared_ptr<const bricks::VoxelSource>(const bricks::Box& cells)> CreatePiece;
};

/// One component of the point scalars of an image that holds all points of the piece.
class ImageSource final : public bricks::VoxelSource
{
public:
  ImageSource(vtkImageData* image, const bricks::Box& cells)
    : Image(image)
    , Cells(cells)
  {
  }
  bricks::Box GetCells() const override { return this->Cells; }
  void ReadSamples(const bricks::Box& points, std::byte* out) const override
  {
    vtkDataArray* scalars = this->Image->GetPointData()->GetScalars();
    const std::size_t row = points.GetSize().x * scalars->GetDataTypeSize();
    for (auto k = points.Min.z; k < points.Max.z; ++k)
    {
      for (auto j = points.Min.y; j < points.Max.y; ++j)
      {
        int ijk[3] = { static_cast<int>(points.Min.x), static_cast<int>(j), static_cast<int>(k) };
        std::memcpy(out, scalars->GetVoidPointer(this->Image->ComputePointId(ijk)), row);
        out += row;
      }
    }
  }

private:
  vtkSmartPointer<vtkImageData> Image;
  bricks::Box Cells;
};

bricks::ScalarType ToScalarType(const std::string& name)
{
  static const std::map<std::string, bricks::ScalarType> types{
    { "char", bricks::ScalarType::Int8 }, { "uchar", bricks::ScalarType::UInt8 },
    { "short", bricks::ScalarType::Int16 }, { "ushort", bricks::ScalarType::UInt16 },
    { "int", bricks::ScalarType::Int32 }, { "uint", bricks::ScalarType::UInt32 },
    { "long", bricks::ScalarType::Int64 }, { "ulong", bricks::ScalarType::UInt64 },
    { "float", bricks::ScalarType::Float32 }, { "double", bricks::ScalarType::Float64 }
  };
  const auto type = types.find(name);
  if (type == types.end())
  {
    throw dsm::Error("\"" + name + "\" is not a scalar type that a sample volume can have.");
  }
  return type->second;
}

bricks::ScalarType ToScalarType(vtkDataArray* array)
{
  const bool floating = array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
  const bool isSigned = array->GetDataTypeMin() < 0.0;
  switch (array->GetDataTypeSize())
  {
    case 1:
      return isSigned ? bricks::ScalarType::Int8 : bricks::ScalarType::UInt8;
    case 2:
      return isSigned ? bricks::ScalarType::Int16 : bricks::ScalarType::UInt16;
    case 4:
      return floating ? bricks::ScalarType::Float32
                      : (isSigned ? bricks::ScalarType::Int32 : bricks::ScalarType::UInt32);
    default:
      return floating ? bricks::ScalarType::Float64
                      : (isSigned ? bricks::ScalarType::Int64 : bricks::ScalarType::UInt64);
  }
}

Input GenerateVolume(const std::string& description)
{
  std::istringstream stream(description);
  std::string kind;
  std::string size;
  std::string type;
  std::getline(stream, kind, ':');
  std::getline(stream, size, ':');
  std::getline(stream, type, ':');
  std::string steps;
  std::getline(stream, steps);
  const int points = std::atoi(size.c_str());
  if ((kind != "sphere" && kind != "rm") || points < 2 ||
    (!steps.empty() && steps != "rectilinear"))
  {
    throw dsm::Error("\"" + description +
      "\" is neither a file that can be read nor a sample volume such as sphere:256:float or "
      "rm:256:uchar.");
  }
  const bricks::SampleVolume volume(
    kind == "sphere" ? bricks::SampleVolume::Kind::Sphere : bricks::SampleVolume::Kind::MixingLayer,
    bricks::Index3(points));
  Input input{ volume.GetPoints(), ToScalarType(type), glm::dmat4(1.0), {}, {} };
  bricks::GridPlanes::Coordinates coordinates;
  for (int axis = 0; axis < 3; ++axis)
  {
    input.IndexToWorld[axis][axis] = volume.GetSpacing();
    input.IndexToWorld[3][axis] = volume.GetOrigin()[axis];
    for (int plane = 0; plane < points; ++plane)
    {
      coordinates[axis].push_back(plane);
    }
  }
  if (!steps.empty())
  {
    input.Planes = std::make_shared<bricks::GridPlanes>(coordinates);
  }
  input.CreatePiece = [volume, scalars = input.Type](const bricks::Box& cells)
  { return std::make_shared<bricks::SampleVolumeSource>(volume, cells, scalars); };
  return input;
}

/// Reads this rank's slab only, where the file allows it.
Input ReadVolume(const std::string& file, int rank, int ranks)
{
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->UpdateInformation();
  int whole[6];
  reader->GetOutputInformation(0)->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
  int extent[6];
  std::copy_n(whole, 6, extent);
  const int cells = whole[5] - whole[4];
  extent[4] = whole[4] + cells * rank / ranks;
  extent[5] = whole[4] + cells * (rank + 1) / ranks;
  static_cast<vtkAlgorithm*>(reader)->UpdateExtent(extent);
  vtkSmartPointer<vtkImageData> image = reader->GetOutput();
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  if (!scalars || scalars->GetNumberOfComponents() != 1)
  {
    throw dsm::Error(file + " could not be read, or its points have no scalars of one component.");
  }
  const bricks::Index3 first(whole[0], whole[2], whole[4]);
  // The lattice starts at index 0, so the image is moved there.
  double origin[3];
  image->TransformIndexToPhysicalPoint(whole[0], whole[2], whole[4], origin);
  Input input{ bricks::Index3(whole[1], whole[3], whole[5]) - first + bricks::Index3(1),
    ToScalarType(scalars), glm::dmat4(1.0), {}, {} };
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int row = 0; row < 3; ++row)
    {
      input.IndexToWorld[axis][row] = image->GetIndexToPhysicalMatrix()->GetElement(row, axis);
    }
    input.IndexToWorld[3][axis] = origin[axis];
  }
  int held[6];
  image->GetExtent(held);
  image->SetExtent(held[0] - whole[0], held[1] - whole[0], held[2] - whole[2], held[3] - whole[2],
    held[4] - whole[4], held[5] - whole[4]);
  input.CreatePiece = [image](const bricks::Box& cells)
  { return std::make_shared<ImageSource>(image, cells); };
  return input;
}

bool EndsWith(const std::string& text, const std::string& end)
{
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

Input CreateInput(const std::string& description, int rank, int ranks)
{
  return EndsWith(description, ".vti") ? ReadVolume(description, rank, ranks)
                                       : GenerateVolume(description);
}

/// Indices [count * part / parts, count * (part + 1) / parts) along an axis of the box.
bricks::Box CutAlong(int axis, const bricks::Box& box, std::int64_t part, std::int64_t parts)
{
  bricks::Box piece = box;
  const std::int64_t count = box.Max[axis] - box.Min[axis];
  piece.Min[axis] = box.Min[axis] + count * part / parts;
  piece.Max[axis] = box.Min[axis] + count * (part + 1) / parts;
  return piece;
}

} // namespace

rt::LatticeIsosurface PublishBenchmarkVolume(const std::string& description, int brickEdge,
  int threads, dsm::BlockStore& store, dsm::Messenger& messenger)
{
  if (vol::MayBeVolumeFile(description))
  {
    return PublishBenchmarkFile(description, brickEdge, store, messenger);
  }
  Input input;
  messenger.RunTogether("Reading the volume",
    [&] { input = CreateInput(description, messenger.GetRank(), messenger.GetSize()); });
  const bricks::BrickLattice lattice(input.Points, input.Type, /*cellMask=*/false,
    brickEdge > 0 ? brickEdge : bricks::BrickLattice::GetDefaultEdge(input.Type));

  const bricks::Box whole{ bricks::Index3(0), lattice.GetCells() };
  const bricks::Box slab = CutAlong(2, whole, messenger.GetRank(), messenger.GetSize());
  std::vector<std::shared_ptr<const bricks::VoxelSource>> pieces;
  for (int thread = 0; thread < threads; ++thread)
  {
    const bricks::Box cells = CutAlong(1, slab, thread, threads);
    if (!cells.IsEmpty())
    {
      pieces.push_back(input.CreatePiece(cells));
    }
  }
  bricks::VolumeSettings settings;
  settings.IsConcurrent = true;
  rt::LatticeIsosurface object;
  object.Field.SetIndexToWorld(input.IndexToWorld);
  const auto field =
    bricks::PublishVolume(description, lattice, pieces, store, messenger, settings);
  field->Planes = input.Planes;
  object.Field.Voxels = field;
  return object;
}

BenchmarkSamples ReadBenchmarkSamples(const std::string& description, int threads)
{
  if (vol::MayBeVolumeFile(description))
  {
    throw dsm::Error(
      "'" + description + "' is not read as a whole. Name a sample volume or a .vti file.");
  }
  const Input input = CreateInput(description, 0, 1);
  if (input.Planes)
  {
    throw dsm::Error("'" + description + "' has planes in tables. Name a volume without.");
  }
  const bricks::Box points{ bricks::Index3(0), input.Points };
  const auto source = input.CreatePiece({ bricks::Index3(0), input.Points - bricks::Index3(1) });
  const std::size_t plane =
    static_cast<std::size_t>(input.Points.x * input.Points.y) * bricks::GetBytes(input.Type);
  BenchmarkSamples samples{ input.Points, input.Type, input.IndexToWorld,
    std::vector<std::byte>(plane * static_cast<std::size_t>(input.Points.z)) };
  std::vector<std::thread> readers;
  for (int thread = 0; thread < threads; ++thread)
  {
    const bricks::Box slab = CutAlong(2, points, thread, threads);
    std::byte* const out = samples.Bytes.data() + plane * static_cast<std::size_t>(slab.Min.z);
    readers.emplace_back([=] { source->ReadSamples(slab, out); });
  }
  for (std::thread& reader : readers)
  {
    reader.join();
  }
  return samples;
}
