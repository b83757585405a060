// SPDX-License-Identifier: BSD-3-Clause
#ifndef PictureFile_h
#define PictureFile_h

#include "DSMRayTracing/frame/FrameGather.h"

#include <cstddef>
#include <fstream>
#include <string>

/// Writes a PPM file.
inline void WritePicture(const rt::Picture& picture, const std::string& path)
{
  std::ofstream file(path, std::ios::binary);
  file << "P6\n" << picture.Width << ' ' << picture.Height << "\n255\n";
  for (int y = picture.Height - 1; y >= 0; --y)
  {
    for (int x = 0; x < picture.Width; ++x)
    {
      const std::size_t pixel = static_cast<std::size_t>(y) * picture.Width + x;
      file.write(reinterpret_cast<const char*>(&picture.Color[4 * pixel]), 3);
    }
  }
}

#endif
