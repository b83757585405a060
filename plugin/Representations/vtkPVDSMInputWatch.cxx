// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMInputWatch.h"

#ifdef DSM_HAS_X11
#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#endif

#ifdef DSM_HAS_X11

namespace
{

/// A window may be gone by the time it is asked about, which by default ends the program.
class ErrorGuard
{
public:
  ErrorGuard()
    : Before(XSetErrorHandler([](Display*, XErrorEvent*) { return 0; }))
  {
  }
  ~ErrorGuard() { XSetErrorHandler(this->Before); }
  ErrorGuard(const ErrorGuard&) = delete;
  void operator=(const ErrorGuard&) = delete;

private:
  XErrorHandler Before;
};

} // namespace

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
    if (!this->Server || this->IsElsewhere())
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

  /// Whether the keyboard is another application's. Nobody knows without a window manager.
  bool IsElsewhere() const
  {
    const ErrorGuard guard;
    const Atom name = XInternAtom(this->Server, "_NET_WM_PID", True);
    Window window = None;
    int revert = 0;
    XGetInputFocus(this->Server, &window, &revert);
    while (name != None && window != None && window != PointerRoot)
    {
      Atom type = None;
      int bits = 0;
      unsigned long count = 0;
      unsigned long left = 0;
      unsigned char* value = nullptr;
      XGetWindowProperty(
        this->Server, window, name, 0, 1, False, XA_CARDINAL, &type, &bits, &count, &left, &value);
      const bool known = type == XA_CARDINAL && bits == 32 && count == 1;
      const auto process = known ? *reinterpret_cast<unsigned long*>(value) : 0;
      if (value)
      {
        XFree(value);
      }
      if (known)
      {
        return process != static_cast<unsigned long>(getpid());
      }
      Window root = None;
      Window parent = None;
      Window* children = nullptr;
      unsigned int childCount = 0;
      if (XQueryTree(this->Server, window, &root, &parent, &children, &childCount) == 0)
      {
        return false;
      }
      if (children)
      {
        XFree(children);
      }
      window = parent;
    }
    return false;
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
