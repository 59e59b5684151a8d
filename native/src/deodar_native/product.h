// Products of small matrices whose rows are vectors.
#pragma once

#include "vectors.h"

namespace {

#if defined(__AVX512F__)
constexpr int TILE_ROWS = 8, TILE_VECTORS = 3;
#else
constexpr int TILE_ROWS = 4, TILE_VECTORS = 2;
#endif

// The matrix on the left: the element of row i and column k is at[i * row + k * column].
struct Left {
  const float* at;
  int64_t row, column;
};

// out (ROWS x VECTORS) = left (ROWS x depth) right (depth x VECTORS); sums stay in registers.
template <int ROWS, int VECTORS>
inline void tile(int64_t depth, Left left, const float* right, int64_t right_row, float* out, int64_t out_row) {
  Vector sums[ROWS][VECTORS];
  for (int i = 0; i < ROWS; ++i)
    for (int j = 0; j < VECTORS; ++j) sums[i][j] = Vector{};
  for (int64_t k = 0; k < depth; ++k) {
    Vector loaded[VECTORS];
#pragma GCC unroll 3
    for (int j = 0; j < VECTORS; ++j) loaded[j] = load(right + k * right_row + LANES * j);
#pragma GCC unroll 8
    for (int i = 0; i < ROWS; ++i) {
      const Vector x = all(left.at[i * left.row + k * left.column]);
#pragma GCC unroll 3
      for (int j = 0; j < VECTORS; ++j) sums[i][j] += x * loaded[j];
    }
  }
#pragma GCC unroll 8
  for (int i = 0; i < ROWS; ++i)
#pragma GCC unroll 3
    for (int j = 0; j < VECTORS; ++j) store(out + i * out_row + LANES * j, sums[i][j]);
}

template <int ROWS, int VECTORS>
inline void last_rows(int64_t rows, int64_t depth, Left left, const float* right, int64_t right_row, float* out,
                      int64_t out_row) {
  if (rows == ROWS) return tile<ROWS, VECTORS>(depth, left, right, right_row, out, out_row);
  if constexpr (ROWS > 1) last_rows<ROWS - 1, VECTORS>(rows, depth, left, right, right_row, out, out_row);
}

template <int VECTORS>
inline void strip(int64_t rows, int64_t depth, Left left, const float* right, int64_t right_row, float* out,
                  int64_t out_row) {
  for (; rows >= TILE_ROWS; rows -= TILE_ROWS) {
    tile<TILE_ROWS, VECTORS>(depth, left, right, right_row, out, out_row);
    left.at += TILE_ROWS * left.row;
    out += TILE_ROWS * out_row;
  }
  last_rows<TILE_ROWS - 1, VECTORS>(rows, depth, left, right, right_row, out, out_row);
}

// out (rows x vectors) = left (rows x depth) right (depth x vectors).
inline void product(int64_t rows, int64_t vectors, int64_t depth, Left left, const float* right, int64_t right_row,
                    float* out, int64_t out_row) {
  for (; vectors >= TILE_VECTORS; vectors -= TILE_VECTORS) {
    strip<TILE_VECTORS>(rows, depth, left, right, right_row, out, out_row);
    right += LANES * TILE_VECTORS;
    out += LANES * TILE_VECTORS;
  }
  if constexpr (TILE_VECTORS > 2)
    if (vectors == 2) strip<2>(rows, depth, left, right, right_row, out, out_row);
  if (vectors == 1) strip<1>(rows, depth, left, right, right_row, out, out_row);
}

}  // namespace
