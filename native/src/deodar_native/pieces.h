// Division of a large call among the threads of XLA.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include "xla/ffi/api/ffi.h"

namespace deodar {

// Call run(0), ..., run(pieces - 1), each once, in this thread and in others of the pool.
//
// Threads take the next piece that none has taken. At the end this thread waits only for pieces that a running
// thread has taken, so a pool whose threads are all busy delays nothing. `run` may be called until this
// function returns; later tasks of the pool find no piece.
template <typename Run>
void in_pieces(xla::ffi::ThreadPool& pool, int64_t pieces, const Run& run) {
  const int64_t threads = pieces > 1 ? pool.num_threads() : 1;
  if (threads <= 1) {
    for (int64_t piece = 0; piece < pieces; ++piece) run(piece);
    return;
  }
  struct Progress {
    std::atomic<int64_t> taken{0}, done{0};
  };
  auto progress = std::make_shared<Progress>();
  const Run* work = &run;
  auto take = [progress, work, pieces]() {
    for (int64_t piece; (piece = progress->taken.fetch_add(1)) < pieces;) {
      (*work)(piece);
      progress->done.fetch_add(1);
    }
  };
  for (int64_t helper = 1; helper < threads && helper < pieces; ++helper) pool.Schedule(std::function<void()>(take));
  take();
  while (progress->done.load() < pieces) std::this_thread::yield();
}

}  // namespace deodar
