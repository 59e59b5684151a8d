// The kernels, compiled once for each instruction set, and the table by which a handler calls them.
#pragma once

#include <cstdint>

namespace deodar {

struct Kernels {
  const char* vectors;  // name of the instruction set

  // Threefry-2x32-20: two words for each cell, counter (cell, block).
  void (*bits)(const uint32_t* key, uint32_t block, uint32_t* first, uint32_t* second, int64_t cells);

  // Standard normal deviates of both ticks of a block, for cells from `from` on.
  void (*noise)(const uint32_t* key, uint32_t block, int64_t from, float* even, float* odd,
                int64_t cells);
};

}  // namespace deodar
