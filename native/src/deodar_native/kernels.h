// The kernels, compiled once for each instruction set, and the table by which a handler calls them.
#pragma once

#include <cstdint>

namespace deodar {

// What is beyond both ends of an axis.
enum class Boundary : int64_t { zero, periodic, reflect };

// The spectral modes of a plane, class after class.
struct PlaneModes {
  int64_t rows, columns;                     // samples
  int64_t outer_classes;                     // 4, or 2 where frequencies are not apart by parity
  const int64_t *outer, *inner;              // number of modes in each class
  const int32_t *outer_places, *inner_places;  // where modes are among those of deodar
  int64_t inner_count;                       // number of modes of deodar along the inner axis
  const float *outer_table, *inner_table;
};

// A logistic output function: 1 / (1 + exp(-beta (u - threshold))).
struct Logistic {
  float beta, threshold;
};

struct Kernels {
  const char* vectors;  // name of the instruction set

  // Threefry-2x32-20: two words for each cell, counter (cell, block).
  void (*bits)(const uint32_t* key, uint32_t block, uint32_t* first, uint32_t* second, int64_t cells);

  // Standard normal deviates of both ticks of a block, for cells from `from` on.
  void (*noise)(const uint32_t* key, uint32_t block, int64_t from, float* even, float* odd,
                int64_t cells);

  // Convolution over one axis with a symmetric kernel of few lags; `scratch` has `line_scratch` floats.
  void (*line)(const float* y, Boundary boundary, const float* weights, int64_t samples, int64_t reach,
               float* scratch, float* out);
  int64_t (*line_scratch)(int64_t samples, int64_t reach);

  // A plane to spectral modes, and back; `scratch` has `plane_scratch` floats.
  void (*plane_to_modes)(const PlaneModes& modes, const float* y, float* scratch, float* out);
  void (*plane_from_modes)(const PlaneModes& modes, const float* given, float* scratch, float* y);
  int64_t (*plane_scratch)(const PlaneModes& modes);

  // The mean of a logistic output over the cells of a line (one row) or a plane; `periodic` for each axis,
  // `scratch` has `cells_scratch` floats.
  void (*cells)(const float* u, int64_t rows, int64_t columns, const bool* periodic, const Logistic& g,
                float* scratch, float* out);
  int64_t (*cells_scratch)(int64_t rows, int64_t columns);
};

}  // namespace deodar
