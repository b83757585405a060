// SPDX-License-Identifier: BSD-3-Clause
#ifndef dsm_ReaderThreads_h
#define dsm_ReaderThreads_h

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace dsm
{

/// Threads that read files for the process, so that no other thread has to wait for a disk. All sources share
/// them: a file system that hangs blocks some of them, but no other thread. Any thread.
class ReaderThreads
{
public:
  /// The threads that all readers of the process share. They start with the first job, and end with the process,
  /// after the reads that are under way.
  static ReaderThreads& GetShared();

  explicit ReaderThreads(int count);
  ~ReaderThreads();
  ReaderThreads(const ReaderThreads&) = delete;
  ReaderThreads& operator=(const ReaderThreads&) = delete;

  /// The job, which throws nothing, is done as soon as a thread is free; jobs begin in order. Those that
  /// have not begun when the threads end, or come later, are dropped. Throws Error when no thread can be started.
  void Add(std::function<void()> job);

  /// Ends the threads, when the reads that they are at have come back.
  void Stop();

private:
  void Run();

  int Count;
  std::mutex Guard;
  std::condition_variable Changed;
  std::deque<std::function<void()>> Jobs;
  std::vector<std::thread> Threads;
  bool IsOver = false;
};

} // namespace dsm

#endif
