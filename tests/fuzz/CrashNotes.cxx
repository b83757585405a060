// SPDX-License-Identifier: BSD-3-Clause
#include "CrashNotes.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <map>

#include <dlfcn.h>
#include <execinfo.h>
#include <sys/time.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#define FUZZ_HAS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define FUZZ_HAS_SANITIZER
#endif
#endif

#ifdef FUZZ_HAS_SANITIZER
extern "C" int __sanitizer_install_malloc_and_free_hooks(
  void (*onMalloc)(const volatile void*, std::size_t), void (*onFree)(const volatile void*));
extern "C" void __sanitizer_symbolize_pc(
  void* place, const char* format, char* out, std::size_t bytes);
#endif

namespace fuzz
{

namespace
{

constexpr int CrashSignals[] = { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT };
/// Functions of HDF5 1.10 that do not end in damaged files: global heaps with an object of no size, local heaps
/// with a free block that follows itself, and selections of virtual datasets with far too many blocks.
constexpr const char* EndlessFunctions[] = { "H5HG__protect", "H5HL_protect",
  "H5S_select_deserialize" };

int CodeForLibrary = EndedInLibrary;
std::map<int, struct sigaction>* Before = nullptr;
std::atomic<std::size_t> MostBytes{ SIZE_MAX };
unsigned long long Inputs = 0;

void Print(const char* text)
{
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
}

bool BeginsWith(const char* text, const char* word)
{
  return std::strncmp(text, word, std::strlen(word)) == 0;
}

/// The functions that are being called, the innermost first.
class Stack
{
public:
  Stack()
    : Count(backtrace(this->Frames, static_cast<int>(std::size(this->Frames))))
  {
  }

  void PrintAll() const { backtrace_symbols_fd(this->Frames, this->Count, STDERR_FILENO); }

  /// Whether libhdf5 called the handler that asks: the innermost function is libhdf5's, without the program's own,
  /// which are the handler, and those of the C and C++ libraries and of the sanitizers behind it.
  bool IsInLibrary() const
  {
    const char* const program = FindModule(reinterpret_cast<void*>(&InstallCrashNotes));
    const auto isHandler = [&](void* place)
    { return std::strcmp(FindModule(place), program) == 0; };
    const auto isPassedOver = [](void* place)
    {
      const char* const module = FindModule(place);
      return BeginsWith(module, "libc.") || BeginsWith(module, "libstdc++") ||
        BeginsWith(module, "libm.") || BeginsWith(module, "libpthread") || IsOfSanitizer(place);
    };
    void* const* const end = this->Frames + this->Count;
    void* const* const caller =
      std::find_if_not(std::find_if_not(this->Frames + 0, end, isHandler), end, isPassedOver);
    return caller != end && BeginsWith(FindModule(*caller), "libhdf5");
  }

  bool IsEndlessInLibrary() const
  {
    return std::any_of(this->Frames, this->Frames + this->Count,
      [](void* place)
      {
        const char* const name = FindName(place);
        return std::any_of(std::begin(EndlessFunctions), std::end(EndlessFunctions),
          [&](const char* known) { return std::strcmp(name, known) == 0; });
      });
  }

private:
  /// The file name of the program or library.
  static const char* FindModule(void* place)
  {
    Dl_info info{};
    if (dladdr(place, &info) == 0 || !info.dli_fname)
    {
      return "";
    }
    const char* const slash = std::strrchr(info.dli_fname, '/');
    return slash ? slash + 1 : info.dli_fname;
  }
  static const char* FindName(void* place)
  {
    Dl_info info{};
    return dladdr(place, &info) != 0 && info.dli_sname ? info.dli_sname : "";
  }
  static bool IsOfSanitizer([[maybe_unused]] void* place)
  {
#ifdef FUZZ_HAS_SANITIZER
    char name[256] = {};
    __sanitizer_symbolize_pc(place, "%f", name, sizeof(name));
    return BeginsWith(name, "__interceptor_") || BeginsWith(name, "__asan") ||
      BeginsWith(name, "__sanitizer") || std::strcmp(name, "free") == 0 ||
      std::strcmp(name, "malloc") == 0 || std::strcmp(name, "realloc") == 0 ||
      std::strcmp(name, "calloc") == 0;
#else
    return false;
#endif
  }

  void* Frames[64];
  int Count;
};

[[noreturn]] void EndInLibrary(const Stack& stack)
{
  Print("This happened in the HDF5 library:\n");
  stack.PrintAll();
  // The process that started this one adds it up (libFuzzer's -fork).
  char text[60];
  std::snprintf(text, sizeof(text), "stat::number_of_executed_units: %llu\n", Inputs);
  Print(text);
  _exit(CodeForLibrary);
}

void NoteCrash(int signal, siginfo_t* info, void* context)
{
  const Stack stack;
  Print("signal: ");
  Print(strsignal(signal));
  Print("\n");
  if (stack.IsInLibrary())
  {
    EndInLibrary(stack);
  }
  const struct sigaction& before = (*Before)[signal];
  if ((before.sa_flags & SA_SIGINFO) != 0) // a sanitizer's
  {
    before.sa_sigaction(signal, info, context);
  }
  stack.PrintAll();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void NoteTime(int)
{
  Print("FAILED: the input takes too long\n");
  const Stack stack;
  if (stack.IsEndlessInLibrary())
  {
    EndInLibrary(stack);
  }
  std::abort();
}

/// False where libhdf5 asks for more than the limit: it gets nothing.
bool MayAllocate(std::size_t bytes)
{
  const std::size_t most = MostBytes;
  if (bytes <= most)
  {
    return true;
  }
  MostBytes = SIZE_MAX; // the stack may need memory
  const Stack stack;
  if (stack.IsInLibrary())
  {
    MostBytes = most;
    return false;
  }
  char text[100];
  std::snprintf(text, sizeof(text), "FAILED: an allocation of %zu bytes\n", bytes);
  Print(text);
  std::abort();
}

} // namespace

void InstallCrashNotes(int codeForLibrary)
{
  CodeForLibrary = codeForLibrary;
  Before = new std::map<int, struct sigaction>;
  const Stack first; // loads what it needs, which allocates
  // Recursion without an end leaves no room on the stack.
  stack_t stack{};
  if (sigaltstack(nullptr, &stack) == 0 && (stack.ss_flags & SS_DISABLE) != 0)
  {
    constexpr std::size_t bytes = 1 << 16;
    stack.ss_sp = std::malloc(bytes);
    stack.ss_size = bytes;
    stack.ss_flags = 0;
    sigaltstack(&stack, nullptr);
  }
  for (const int signal : CrashSignals)
  {
    struct sigaction action
    {
    };
    action.sa_sigaction = &NoteCrash;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
    sigaction(signal, &action, &(*Before)[signal]);
  }
}

void BlameLibrary(const char* what)
{
  Print(what);
  EndInLibrary(Stack());
}

void LimitTime(unsigned seconds)
{
  Inputs += seconds > 0 ? 1 : 0;
  std::signal(SIGPROF, &NoteTime);
  std::signal(SIGALRM, &NoteTime);
  const itimerval limit{ { 0, 0 }, { static_cast<time_t>(seconds), 0 } };
  setitimer(ITIMER_PROF, &limit, nullptr);
  alarm(10 * seconds);
}

} // namespace fuzz

#ifdef FUZZ_HAS_SANITIZER

void fuzz::LimitAllocations(std::size_t bytes)
{
  MostBytes = bytes;
  const auto onMalloc = [](const volatile void*, std::size_t count)
  {
    if (!MayAllocate(count))
    {
      EndInLibrary(Stack());
    }
  };
  __sanitizer_install_malloc_and_free_hooks(onMalloc, [](const volatile void*) {});
}

#else

void fuzz::LimitAllocations(std::size_t bytes)
{
  MostBytes = bytes;
}

// The program's own functions take the place of the C library's, for all libraries.
extern "C"
{
  void* __libc_malloc(std::size_t bytes);
  void* __libc_calloc(std::size_t count, std::size_t bytes);
  void* __libc_realloc(void* old, std::size_t bytes);

  void* malloc(std::size_t bytes)
  {
    return fuzz::MayAllocate(bytes) ? __libc_malloc(bytes) : nullptr;
  }
  void* calloc(std::size_t count, std::size_t bytes)
  {
    std::size_t all = 0;
    const bool fits = !__builtin_mul_overflow(count, bytes, &all);
    return fuzz::MayAllocate(fits ? all : SIZE_MAX) ? __libc_calloc(count, bytes) : nullptr;
  }
  void* realloc(void* old, std::size_t bytes)
  {
    return fuzz::MayAllocate(bytes) ? __libc_realloc(old, bytes) : nullptr;
  }
}

#endif
