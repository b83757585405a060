// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMVolumeWriter.h"

#include "DSMCore/base/Error.h"
#include "DSMVolumeFiles/write/WriteBrickFile.h"
#include "vtkDSMErrorGuard.h"
#include "vtkDSMImageOrigin.h"
#include "vtkDSMRankGroup.h"

#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <memory>

vtkStandardNewMacro(vtkDSMVolumeWriter);

namespace
{

vol::Compression ToCompression(int value)
{
  switch (value)
  {
    case vtkDSMVolumeWriter::DEFLATE:
      return vol::Compression::Deflate;
    case vtkDSMVolumeWriter::ZSTANDARD:
      return vol::Compression::Zstd;
    default:
      return vol::Compression::None;
  }
}

} // namespace

vtkDSMVolumeWriter::vtkDSMVolumeWriter()
  : Controller(vtkMultiProcessController::GetGlobalController())
{
}

vtkDSMVolumeWriter::~vtkDSMVolumeWriter() = default;

void vtkDSMVolumeWriter::SetFileName(const char* name)
{
  const std::string wanted = name ? name : "";
  if (wanted != this->FileName)
  {
    this->FileName = wanted;
    this->Modified();
  }
}

const char* vtkDSMVolumeWriter::GetFileName() const
{
  return this->FileName.c_str();
}

void vtkDSMVolumeWriter::SetCompression(int compression)
{
  const int wanted = std::clamp<int>(compression, NONE, ZSTANDARD);
  if (wanted != this->Compression)
  {
    this->Compression = wanted;
    this->Modified();
  }
}

void vtkDSMVolumeWriter::SetCoarserLevels(bool coarser)
{
  if (coarser != this->CoarserLevels)
  {
    this->CoarserLevels = coarser;
    this->Modified();
  }
}

void vtkDSMVolumeWriter::SetController(vtkMultiProcessController* controller)
{
  if (controller != this->Controller)
  {
    this->Controller = controller;
    this->Modified();
  }
}

vtkMultiProcessController* vtkDSMVolumeWriter::GetController() const
{
  return this->Controller;
}

int vtkDSMVolumeWriter::Write()
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->HasJoined = false;
  this->Superclass::Write();
  if (!this->HasJoined) // VTK has said why
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    try
    {
      this->Join(vtkDSMRankGroup::Get(this->Controller)->GetMessenger(), false);
    }
    catch (const std::exception&) // the other ranks say that this one has nothing
    {
      return 0;
    }
  }
  return this->GetErrorCode() == vtkErrorCode::NoError ? 1 : 0;
}

int vtkDSMVolumeWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

vtkTypeBool vtkDSMVolumeWriter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** input, vtkInformationVector* output)
{
  return vtkDSMErrorGuard::Run(this, "writing", this->GetFileName(),
    [&]() -> int
    {
      if (!request->Has(vtkStreamingDemandDrivenPipeline::REQUEST_UPDATE_EXTENT()) ||
        !this->Controller)
      {
        return this->Superclass::ProcessRequest(request, input, output);
      }
      vtkInformation* const info = input[0]->GetInformationObject(0);
      using Pipeline = vtkStreamingDemandDrivenPipeline;
      info->Set(Pipeline::UPDATE_PIECE_NUMBER(), this->Controller->GetLocalProcessId());
      info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), this->Controller->GetNumberOfProcesses());
      info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
      return 1;
    });
}

void vtkDSMVolumeWriter::Join(dsm::Messenger& messenger, bool hasImage)
{
  this->HasJoined = true;
  messenger.RunTogether("Writing '" + this->FileName + "'",
    [&]
    {
      if (!hasImage)
      {
        throw dsm::Error("There is no image to write.");
      }
    });
}

void vtkDSMVolumeWriter::WriteData()
{
  const int done = vtkDSMErrorGuard::Run(this, "writing", this->GetFileName(),
    [&]
    {
      this->WriteImage();
      return 1;
    });
  if (done == 0)
  {
    this->SetErrorCode(vtkErrorCode::UserError);
  }
}

void vtkDSMVolumeWriter::WriteImage()
{
  const auto group = vtkDSMRankGroup::Get(this->Controller);
  dsm::Messenger& messenger = group->GetMessenger();
  this->Join(messenger, true);
  if (this->FileName.empty())
  {
    throw dsm::Error("The name of the file to write is empty. Set FileName.");
  }
  auto origin =
    std::make_unique<vtkDSMImageOrigin>(messenger, vtkImageData::SafeDownCast(this->GetInput()));
  if (!origin->GetLeftOut().empty() && messenger.GetRank() == 0)
  {
    std::string names;
    for (const std::string& name : origin->GetLeftOut())
    {
      names += (names.empty() ? "'" : ", '") + name + "'";
    }
    vtkWarningMacro("Not written to '"
      << this->FileName << "': " << names
      << ". These arrays are not numeric, or differ between the pieces of the image.");
  }
  vol::WriteOptions options;
  options.IsResumable = false; // the image is gone when the session ends
  options.Pressed = ToCompression(this->Compression);
  options.Levels = this->CoarserLevels ? vol::WriteOptions::AllLevels : 0;
  options.Threads = messenger.GetCoresPerRank();
  const std::uint64_t limit = group->GetStore().GetSettings().MemoryBytes;
  options.MemoryBytes = limit == 0
    ? options.MemoryBytes
    : static_cast<std::size_t>(std::min<std::uint64_t>(limit, options.MemoryBytes));
  vol::WriteBrickFile(std::move(origin), this->FileName, options, messenger,
    [this](double part) { this->UpdateProgress(part); });
}

void vtkDSMVolumeWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << endl;
  os << indent << "Compression: " << this->Compression << endl;
  os << indent << "CoarserLevels: " << this->CoarserLevels << endl;
  os << indent << "Controller: " << this->Controller << endl;
}
