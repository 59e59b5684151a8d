// Convolution over one axis with a symmetric kernel of few lags.
#pragma once

#include "kernels.h"
#include "vectors.h"

namespace {

using deodar::Boundary;

// out_i = sum of weights[|k|] * wide[reach + i + k] over |k| <= reach, for COUNT vectors of i.
//
// Lags of equal remainder by the length of a vector read vectors at equal places, so a copy of `wide`, moved by
// the remainder, makes all loads of the inner loop aligned.
template <int COUNT>
void line_block(const float* wide, const float* weights, int64_t reach, float* moved, float* out) {
  Vector sums[COUNT];
  for (int j = 0; j < COUNT; ++j) sums[j] = Vector{};
  const int64_t lags = 2 * reach + 1;
  for (int64_t remainder = 0; remainder < LANES && remainder < lags; ++remainder) {
    const int64_t steps = (lags - remainder + LANES - 1) / LANES;
    for (int64_t q = 0; q < COUNT + steps - 1; ++q)
      store_aligned(moved + LANES * q, load(wide + LANES * q + remainder));
    for (int64_t step = 0; step < steps; ++step) {
      const int64_t lag = LANES * step + remainder - reach;
      const Vector weight = all(weights[lag < 0 ? -lag : lag]);
      const float* from = moved + LANES * step;
#pragma GCC unroll 14
      for (int j = 0; j < COUNT; ++j) sums[j] += weight * load_aligned(from + LANES * j);
    }
  }
  for (int j = 0; j < COUNT; ++j) store(out + LANES * j, sums[j]);
}

template <int COUNT>
void line_blocks(int64_t count, const float* wide, const float* weights, int64_t reach, float* moved, float* out) {
  if constexpr (COUNT > 1)
    if (count < COUNT) return line_blocks<COUNT - 1>(count, wide, weights, reach, moved, out);
  line_block<COUNT>(wide, weights, reach, moved, out);
}

int64_t line_scratch(int64_t samples, int64_t reach) {
  return LANES * vectors_of(SUMS * LANES + 2 * reach + LANES) + SUMS * LANES + samples + 2 * reach + 2 * LANES;
}

// Write y with the `reach` samples beyond both ends.
void widen(const float* y, Boundary boundary, int64_t samples, int64_t reach, float* wide) {
  float* after = wide + reach + samples;
  std::memcpy(wide + reach, y, sizeof(float) * samples);
  for (int64_t k = 0; k < reach; ++k) {
    switch (boundary) {
      case Boundary::zero: wide[k] = after[k] = 0.0f; break;
      case Boundary::periodic: wide[k] = y[samples - reach + k]; after[k] = y[k]; break;
      case Boundary::reflect: wide[k] = y[reach - 1 - k]; after[k] = y[samples - 1 - k]; break;
    }
  }
  std::memset(after + reach, 0, sizeof(float) * 2 * LANES);
}

void line(const float* y, Boundary boundary, const float* weights, int64_t samples, int64_t reach,
          float* scratch, float* out) {
  const int64_t vectors = vectors_of(samples), blocks = (vectors + SUMS - 1) / SUMS;
  float* moved = scratch;
  float* last = moved + LANES * vectors_of(SUMS * LANES + 2 * reach + LANES);
  float* wide = last + SUMS * LANES;
  widen(y, boundary, samples, reach, wide);
  for (int64_t block = 0; block < blocks; ++block) {
    const int64_t from = block * vectors / blocks, to = (block + 1) * vectors / blocks;
    const bool whole = LANES * to <= samples;
    float* place = whole ? out + LANES * from : last;
    line_blocks<SUMS>(to - from, wide + LANES * from, weights, reach, moved, place);
    if (!whole) std::memcpy(out + LANES * from, last, sizeof(float) * (samples - LANES * from));
  }
}

}  // namespace
