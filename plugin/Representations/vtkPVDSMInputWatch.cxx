// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMInputWatch.h"

#ifdef DSM_HAS_X11
#include <X11/Xlib.h>

#include <algorithm>
#include <array>
#endif

#ifdef DSM_HAS_X11

class vtkPVDSMInputWatch::Internals
{
public:
  Internals()
    : Server(XOpenDisplay(nullptr))
  {
  }
  ~Internals()
  {
    if (this->Server)
    {
      XCloseDisplay(this->Server);
    }
  }
  Internals(const Internals&) = delete;
  void operator=(const Internals&) = delete;

  /// A bit for each key, then the buttons.
  static constexpr int KeyBytes = 32;
  using Held = std::array<unsigned char, KeyBytes + 1>;

  Held Ask() const
  {
    Held held{};
    if (!this->Server)
    {
      return held;
    }
    char keys[KeyBytes];
    XQueryKeymap(this->Server, keys);
    std::copy_n(keys, KeyBytes, held.begin());
    Window root;
    Window child;
    int places[4];
    unsigned int mask = 0;
    XQueryPointer(this->Server, DefaultRootWindow(this->Server), &root, &child, &places[0],
      &places[1], &places[2], &places[3], &mask);
    constexpr unsigned int buttons = Button1Mask | Button2Mask | Button3Mask;
    held[KeyBytes] = static_cast<unsigned char>((mask & buttons) / Button1Mask);
    return held;
  }

  Display* Server; ///< null where there is none
  Held Before{};
};

void vtkPVDSMInputWatch::Begin()
{
  if (!this->Self)
  {
    this->Self = std::make_unique<Internals>();
  }
  this->Self->Before = this->Self->Ask();
}

bool vtkPVDSMInputWatch::HasPressed() const
{
  if (!this->Self)
  {
    return false;
  }
  const Internals::Held now = this->Self->Ask();
  return !std::equal(now.begin(), now.end(), this->Self->Before.begin(),
    [](unsigned char held, unsigned char before) { return (held & ~before) == 0; });
}

#else

class vtkPVDSMInputWatch::Internals
{
};

void vtkPVDSMInputWatch::Begin() {}

bool vtkPVDSMInputWatch::HasPressed() const
{
  return false;
}

#endif

vtkPVDSMInputWatch::vtkPVDSMInputWatch() = default;
vtkPVDSMInputWatch::~vtkPVDSMInputWatch() = default;
