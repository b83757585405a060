// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMImageCompressor.h"

#include "vtkPVDSMClientWatch.h"

#include "vtkObjectFactory.h"
#include "vtkPVClientServerSynchronizedRenderers.h"
#include "vtkPVRenderView.h"
#include "vtkPVSynchronizedRenderer.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>

#ifdef DSM_HAS_ZSTD
#include <zstd.h>
#endif

namespace
{

/// Follows a picture's compressed bytes.
struct Trailer
{
  enum Kind : std::uint32_t
  {
    FromRowBelow,
    FromLastPicture
  };
  static constexpr std::uint32_t Mark = 0x44534D31; // "DSM1"

  std::uint32_t Magic;
  std::uint32_t Prediction;
};

/// Only subclasses may ask for these. None of them is ever made.
struct SentView : vtkPVRenderView
{
  static vtkPVSynchronizedRenderer* GetRenderers(vtkPVRenderView* view)
  {
    return view->*&SentView::SynchronizedRenderers;
  }
};
struct SentRenderers : vtkPVClientServerSynchronizedRenderers
{
  static vtkImageCompressor* Get(vtkPVClientServerSynchronizedRenderers* renderers)
  {
    return (renderers->*&SentRenderers::GetCompressor)();
  }
  static void Set(vtkPVClientServerSynchronizedRenderers* renderers, vtkImageCompressor* compressor)
  {
    (renderers->*&SentRenderers::SetCompressor)(compressor);
  }
};

#ifdef DSM_HAS_ZSTD
std::size_t CountBytes(vtkUnsignedCharArray* pixels)
{
  return static_cast<std::size_t>(pixels->GetNumberOfValues());
}

/// Returns the bytes of a row; those of the whole picture if the width is unknown.
std::size_t CountRowBytes(vtkIdType width, vtkUnsignedCharArray* pixels)
{
  const auto row = static_cast<std::size_t>(width * pixels->GetNumberOfComponents());
  return row > 0 ? std::min(row, CountBytes(pixels)) : CountBytes(pixels);
}

/// Writes how `bytes` values differ from their predictions.
void Subtract(const unsigned char* values, const unsigned char* predicted, std::size_t bytes,
  unsigned char* difference)
{
  std::transform(values, values + bytes, predicted, difference, std::minus<unsigned char>());
}

/// The reverse.
void Add(const unsigned char* difference, const unsigned char* predicted, std::size_t bytes,
  unsigned char* values)
{
  std::transform(difference, difference + bytes, predicted, values, std::plus<unsigned char>());
}

/// Returns how many of `bytes` values are like the others.
std::size_t CountLike(const unsigned char* pixels, const unsigned char* others, std::size_t bytes)
{
  std::size_t count = 0;
  for (std::size_t at = 0; at < bytes; ++at)
  {
    count += pixels[at] == others[at] ? 1 : 0;
  }
  return count;
}
#endif

} // namespace

vtkStandardNewMacro(vtkPVDSMImageCompressor);

vtkPVDSMImageCompressor::vtkPVDSMImageCompressor() = default;
vtkPVDSMImageCompressor::~vtkPVDSMImageCompressor() = default;

bool vtkPVDSMImageCompressor::IsAvailable()
{
#ifdef DSM_HAS_ZSTD
  return true;
#else
  return false;
#endif
}

void vtkPVDSMImageCompressor::Use(vtkPVRenderView* view)
{
  vtkPVSynchronizedRenderer* const all = view ? SentView::GetRenderers(view) : nullptr;
  auto* const renderers =
    vtkPVClientServerSynchronizedRenderers::SafeDownCast(all ? all->GetCSSynchronizer() : nullptr);
  vtkImageCompressor* const present = renderers ? SentRenderers::Get(renderers) : nullptr;
  if (IsAvailable() && present && present->IsA("vtkLZ4Compressor") &&
    !present->IsA("vtkPVDSMImageCompressor"))
  {
    vtkNew<vtkPVDSMImageCompressor> own;
    own->RestoreConfiguration(present->SaveConfiguration());
    SentRenderers::Set(renderers, own);
  }
}

void vtkPVDSMImageCompressor::SetImageResolution(int width, int height)
{
  this->Superclass::SetImageResolution(width, height);
  this->Width = width;
}

int vtkPVDSMImageCompressor::Compress()
{
#ifdef DSM_HAS_ZSTD
  // Several clients would each have another last picture.
  if (this->Input && this->Output && vtkPVDSMClientWatch::CountClients() == 1)
  {
    const std::size_t bytes = CountBytes(this->Input);
    const std::size_t row = CountRowBytes(this->Width, this->Input);
    const unsigned char* const pixels = this->Input->GetPointer(0);
    const bool isLike = CountBytes(this->Last) == bytes &&
      CountLike(pixels, this->Last->GetPointer(0), bytes) >
        CountLike(pixels + row, pixels, bytes - row);
    const Trailer trailer{ Trailer::Mark,
      isLike ? Trailer::FromLastPicture : Trailer::FromRowBelow };
    unsigned char* const difference =
      this->Difference->WritePointer(0, static_cast<vtkIdType>(bytes));
    if (isLike)
    {
      Subtract(pixels, this->Last->GetPointer(0), bytes, difference);
    }
    else
    {
      std::copy_n(pixels, row, difference);
      Subtract(pixels + row, pixels, bytes - row, difference + row);
    }
    constexpr int quickest = 1;
    const std::size_t room = ZSTD_compressBound(bytes);
    unsigned char* const sent =
      this->Output->WritePointer(0, static_cast<vtkIdType>(room + sizeof(trailer)));
    const std::size_t size = ZSTD_compress(sent, room, difference, bytes, quickest);
    if (ZSTD_isError(size))
    {
      vtkErrorMacro("Cannot compress a picture: " << ZSTD_getErrorName(size));
      return VTK_ERROR;
    }
    std::memcpy(sent + size, &trailer, sizeof(trailer));
    this->Output->SetNumberOfTuples(static_cast<vtkIdType>(size + sizeof(trailer)));
    this->Last->DeepCopy(this->Input);
    return VTK_OK;
  }
#endif
  this->Last->Initialize();
  return this->Superclass::Compress();
}

int vtkPVDSMImageCompressor::Decompress()
{
#ifdef DSM_HAS_ZSTD
  Trailer trailer{};
  std::size_t size = this->Input ? CountBytes(this->Input) : 0;
  if (this->Output && size > sizeof(trailer))
  {
    size -= sizeof(trailer);
    std::memcpy(&trailer, this->Input->GetPointer(0) + size, sizeof(trailer));
  }
  if (trailer.Magic == Trailer::Mark)
  {
    const std::size_t bytes = CountBytes(this->Output);
    const std::size_t row = CountRowBytes(this->Width, this->Output);
    unsigned char* const pixels = this->Output->GetPointer(0);
    if (ZSTD_decompress(pixels, bytes, this->Input->GetPointer(0), size) != bytes ||
      (trailer.Prediction == Trailer::FromLastPicture && CountBytes(this->Last) != bytes))
    {
      vtkErrorMacro("A picture of the server is not one of " << bytes << " bytes.");
      return VTK_ERROR;
    }
    if (trailer.Prediction == Trailer::FromLastPicture)
    {
      Add(pixels, this->Last->GetPointer(0), bytes, pixels);
    }
    else
    {
      // Row by row: each needs the one below.
      for (std::size_t at = row; at < bytes; at += row)
      {
        Add(pixels + at, pixels + at - row, std::min(row, bytes - at), pixels + at);
      }
    }
    this->Last->DeepCopy(this->Output);
    return VTK_OK;
  }
#endif
  this->Last->Initialize();
  return this->Superclass::Decompress();
}

void vtkPVDSMImageCompressor::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Width: " << this->Width << "\n";
}
