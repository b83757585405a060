// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMInputWatch.h"

#ifdef DSM_HAS_X11
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/extensions/XInput2.h>

#include <unistd.h>

#include <algorithm>
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
    if (this->Server && !this->Listen())
    {
      XCloseDisplay(this->Server);
      this->Server = nullptr;
    }
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

  /// Discards the events received so far.
  void Begin()
  {
    this->Read();
    this->HasCome = false;
  }

  bool HasPressed()
  {
    this->Read();
    this->HasCome = this->HasCome && !this->IsElsewhere();
    return this->HasCome;
  }

private:
  /// Raw events come whichever window has grabbed the mouse or the keyboard. Returns false where the server has none.
  bool Listen()
  {
    int event = 0;
    int error = 0;
    int major = 2;
    int minor = 1;
    if (!XQueryExtension(this->Server, "XInputExtension", &this->Opcode, &event, &error) ||
      XIQueryVersion(this->Server, &major, &minor) != Success)
    {
      return false;
    }
    unsigned char bits[XIMaskLen(XI_LASTEVENT)] = {};
    for (const int kind :
      { XI_RawKeyPress, XI_RawKeyRelease, XI_RawButtonPress, XI_RawButtonRelease, XI_RawMotion })
    {
      XISetMask(bits, kind);
    }
    XIEventMask mask{ XIAllMasterDevices, sizeof(bits), bits };
    XISelectEvents(this->Server, DefaultRootWindow(this->Server), &mask, 1);
    XFlush(this->Server);
    return true;
  }

  /// Takes all events that have come; none waits for the server.
  void Read()
  {
    while (this->Server && XPending(this->Server) > 0)
    {
      XEvent event;
      XNextEvent(this->Server, &event);
      if (event.type == GenericEvent && event.xcookie.extension == this->Opcode)
      {
        this->Count(event.xcookie.evtype);
      }
    }
  }

  /// The wheel presses buttons, too. The mouse counts where it drags something.
  void Count(int kind)
  {
    if (kind == XI_RawMotion)
    {
      this->HasCome = this->HasCome || this->ButtonsHeld > 0;
      return;
    }
    this->HasCome = true;
    if (kind == XI_RawButtonPress)
    {
      ++this->ButtonsHeld;
    }
    else if (kind == XI_RawButtonRelease)
    {
      this->ButtonsHeld = std::max(0, this->ButtonsHeld - 1);
    }
  }

  /// Returns whether another application has the keyboard focus. Unknown without a window manager.
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
  int Opcode = 0;  ///< of the events' extension
  int ButtonsHeld = 0;
  bool HasCome = false;
};

void vtkPVDSMInputWatch::Begin()
{
  if (!this->Self)
  {
    this->Self = std::make_unique<Internals>();
  }
  this->Self->Begin();
}

bool vtkPVDSMInputWatch::HasPressed()
{
  return this->Self && this->Self->HasPressed();
}

#else

class vtkPVDSMInputWatch::Internals
{
};

void vtkPVDSMInputWatch::Begin() {}

bool vtkPVDSMInputWatch::HasPressed()
{
  return false;
}

#endif

vtkPVDSMInputWatch::vtkPVDSMInputWatch() = default;
vtkPVDSMInputWatch::~vtkPVDSMInputWatch() = default;
