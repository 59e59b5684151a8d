// The mean of a logistic output over the cells of a grid: the rule `cell` of deodar/numerics/quadrature.py, with
// the same weights.
#pragma once

#include "kernels.h"
#include "vectors.h"

namespace {

using deodar::Logistic;

typedef int32_t Integers __attribute__((vector_size(4 * LANES)));

constexpr int BESIDE = 8;  // samples beyond both ends that the rule reads
constexpr int INTERVALS = 5;  // halves of intervals beside those of the samples
constexpr float AT_SAMPLES[6] = {29 / 230400.0f,    -519 / 230400.0f,  5547 / 230400.0f,
                                 -24792 / 230400.0f, 52024 / 230400.0f, 165822 / 230400.0f};
constexpr float BETWEEN[6] = {29 / 921600.0f,   -374 / 921600.0f,   2836 / 921600.0f,
                              5135 / 921600.0f, -96316 / 921600.0f, 549490 / 921600.0f};
constexpr float FROM_HALVES[6] = {29 / 15360.0f,   -229 / 15360.0f, 1546 / 15360.0f,
                                  7166 / 15360.0f, -919 / 15360.0f, 87 / 15360.0f};
constexpr float CLOSE = 0.01f;  // range of beta u below which a mean is a Taylor series
constexpr float FLAT = 1e-9f;   // fourth power of the slope below which no direction is preferred

inline Vector select(Integers mask, Vector yes, Vector no) {
  return reinterpret_cast<Vector>((mask & reinterpret_cast<Integers>(yes)) | (~mask & reinterpret_cast<Integers>(no)));
}
inline Vector above_zero(Vector x) { return select(x > Vector{}, x, Vector{}); }
inline Vector magnitude(Vector x) { return reinterpret_cast<Vector>(reinterpret_cast<Integers>(x) & 0x7FFFFFFF); }

// exp(-x) for x >= 0, at least 2^-100, whose products are no denormal numbers: a power of two and a polynomial on
// [-1/2, 1/2] in its exponent.
inline Vector exp_of_minus(Vector x) {
  const Vector turns = x * all(-1.44269504f);
  const Vector bounded = select(turns > all(-100.0f), turns, all(-100.0f));
  const Vector rounded = bounded + all(12582912.0f);  // 1.5 x 2^23: no digits behind the point
  const Vector rest = bounded - (rounded - all(12582912.0f));
  Vector p = all(1.33335581e-3f);
  p = p * rest + all(9.61812911e-3f);
  p = p * rest + all(5.55041087e-2f);
  p = p * rest + all(2.40226507e-1f);
  p = p * rest + all(6.93147181e-1f);
  p = p * rest + all(1.0f);
  return reinterpret_cast<Vector>(reinterpret_cast<Integers>(p) + (reinterpret_cast<Integers>(rounded) << 23));
}

// log(1 + y) for 0 <= y <= 1: the polynomial of deodar/numerics/sigmoids.py.
inline Vector log_of_one_and(Vector y) {
  Vector p = all(-0.00853880788f);
  p = p * y + all(0.0440882267f);
  p = p * y + all(-0.107679777f);
  p = p * y + all(0.17745109f);
  p = p * y + all(-0.244954163f);
  p = p * y + all(0.33275472f);
  p = p * y + all(-0.499974049f);
  p = p * y + all(0.999999806f);
  return y * p;
}

// beta (u - threshold) at samples or between them, and the expensive terms of the means that end there.
struct Ends {
  float *v, *decaying, *small;

  // From `weights`, COUNT of them with their mirror images; an odd number of samples has a middle.
  template <int COUNT, bool MIDDLE>
  void fill(int64_t count, const Logistic& g, const float* wide, int64_t stride, const float* weights) {
    const Vector beta = all(g.beta), threshold = all(g.threshold);
    constexpr int LAST = 2 * COUNT - (MIDDLE ? 0 : 1);
    for (int64_t i = 0; i < count; i += LANES) {
      const float* from = wide + i;
      Vector sum = MIDDLE ? all(weights[COUNT]) * load(from + COUNT * stride) : Vector{};
#pragma GCC unroll 6
      for (int k = 0; k < COUNT; ++k)
        sum += all(weights[k]) * (load(from + k * stride) + load(from + (LAST - k) * stride));
      const Vector scaled = beta * (sum - threshold), e = exp_of_minus(magnitude(scaled));
      store_aligned(v + i, scaled);
      store_aligned(small + i, e);
      store_aligned(decaying + i, log_of_one_and(e));
    }
  }
};

// The mean of g between two ends, near the first one a Taylor series.
inline Vector mean_between(Vector va, Vector low, Vector s, Vector vb, Vector high) {
  const Vector d = vb - va, q = s + all(1.0f);
  const Vector series = select(va > Vector{}, all(1.0f), s) * q + all(0.5f) * s * d;
  const Integers close = magnitude(d) < all(CLOSE);
  return select(close, series, above_zero(vb) - above_zero(va) + (high - low)) / select(close, q * q, d);
}

// The rule along an axis of which `stride` floats are one sample; `wide` has BESIDE samples beyond both ends.
// `out` has whole vectors.
void cells_along(const float* wide, int64_t samples, int64_t stride, const Logistic& g, float* scratch, float* out) {
  const int64_t count = samples * stride, size = LANES * vectors_of(count + 8 * stride + LANES);
  const int64_t halves = count + INTERVALS * stride;
  Ends at = {scratch, scratch + size, scratch + 2 * size};
  Ends between = {scratch + 3 * size, scratch + 4 * size, scratch + 5 * size};
  float *near = scratch + 6 * size, *far = scratch + 7 * size;
  at.fill<5, true>(halves + stride, g, wide, stride, AT_SAMPLES);
  between.fill<6, false>(halves, g, wide, stride, BETWEEN);
  for (int64_t i = 0; i < halves; i += LANES) {
    const Vector v = load_aligned(between.v + i), high = load_aligned(between.decaying + i);
    const int64_t j = i + stride;
    store_aligned(near + i, mean_between(load_aligned(at.v + i), load_aligned(at.decaying + i),
                                         load_aligned(at.small + i), v, high));
    store_aligned(far + i, mean_between(load(at.v + j), load(at.decaying + j), load(at.small + j), v, high));
  }
  for (int64_t i = 0; i < count; i += LANES) {
    Vector sum = Vector{};
#pragma GCC unroll 6
    for (int k = 0; k < 6; ++k)
      sum += all(FROM_HALVES[k]) * (load(near + i + k * stride) + load(far + i + (5 - k) * stride));
    store(out + i, sum);
  }
}

// Floats of `scratch` of `cells_along`, and of `wide` before it.
int64_t along_scratch(int64_t samples, int64_t stride) {
  return 8 * LANES * vectors_of((samples + 8) * stride + LANES);
}
int64_t wide_floats(int64_t samples, int64_t stride) {
  return LANES * vectors_of((samples + 2 * BESIDE) * stride + 2 * LANES);
}

// Write the samples beyond both ends: of the other end if the axis is periodic, else in a straight line.
void continued(float* wide, int64_t samples, int64_t stride, bool periodic) {
  float *first = wide + BESIDE * stride, *last = first + (samples - 1) * stride;
  for (int64_t k = 1; k <= BESIDE; ++k) {
    float *before = first - k * stride, *after = last + k * stride;
    if (periodic) {
      const int64_t turned = k <= samples ? k - 1 : (k - 1) % samples;
      std::memcpy(before, last - turned * stride, sizeof(float) * stride);
      std::memcpy(after, first + turned * stride, sizeof(float) * stride);
      continue;
    }
    for (int64_t i = 0; i < stride; ++i) {
      before[i] = first[i] + static_cast<float>(k) * (first[i] - first[stride + i]);
      after[i] = last[i] + static_cast<float>(k) * (last[i] - last[i - stride]);
    }
  }
  std::memset(wide + (samples + 2 * BESIDE) * stride, 0, sizeof(float) * 2 * LANES);
}

int64_t cells_scratch(int64_t rows, int64_t columns) {
  const int64_t inner = wide_floats(columns, 1) + along_scratch(columns, 1) + LANES * vectors_of(columns);
  if (rows == 1) return inner;
  const int64_t outer = wide_floats(rows, columns) + along_scratch(rows, columns);
  return LANES * vectors_of(rows * columns + LANES) + (inner > outer ? inner : outer);
}

// The fourth power of the difference of both neighbours.
inline Vector steepness(Vector before, Vector after) {
  const Vector step = after - before, squared = step * step;
  return squared * squared + all(FLAT);
}

// The output of a line (one row) or a plane.
void cells(const float* u, int64_t rows, int64_t columns, const bool* periodic, const Logistic& g, float* scratch,
           float* out) {
  const bool plane = rows > 1;
  float* outer = scratch;  // of a plane: the rule along its rows
  if (plane) {
    float* rest = outer + LANES * vectors_of(rows * columns + LANES);
    std::memcpy(rest + BESIDE * columns, u, sizeof(float) * rows * columns);
    continued(rest, rows, columns, periodic[0]);
    cells_along(rest, rows, columns, g, rest + wide_floats(rows, columns), outer);
    scratch = rest;
  }
  float* wide = scratch;
  float* row = wide + wide_floats(columns, 1);
  float* rest = row + LANES * vectors_of(columns);
  for (int64_t r = 0; r < rows; ++r) {
    std::memcpy(wide + BESIDE, u + r * columns, sizeof(float) * columns);
    continued(wide, columns, 1, periodic[plane ? 1 : 0]);
    cells_along(wide, columns, 1, g, rest, row);
    if (plane) {
      const float* here = u + r * columns;
      const float* up = r > 0 ? here - columns : periodic[0] ? u + (rows - 1) * columns : nullptr;
      const float* down = r + 1 < rows ? here + columns : periodic[0] ? u : nullptr;
      for (int64_t i = 0; i < columns; i += LANES) {
        float part[3][LANES] = {};
        const int64_t width = columns - i < LANES ? columns - i : LANES;
        const float* from[3] = {up, here, down};
        Vector around[3];
        for (int k = 0; k < 3; ++k) {
          if (!from[k]) continue;
          if (width == LANES) {
            around[k] = load(from[k] + i);
          } else {
            std::memcpy(part[k], from[k] + i, sizeof(float) * width);
            around[k] = load(part[k]);
          }
        }
        // beyond an end the plane continues in a straight line
        if (!up) around[0] = around[1] + around[1] - around[2];
        if (!down) around[2] = around[1] + around[1] - around[0];
        const Vector w0 = steepness(around[0], around[2]);
        const Vector w1 = steepness(load(wide + BESIDE + i - 1), load(wide + BESIDE + i + 1));
        const Vector o0 = load(outer + r * columns + i);
        store(row + i, (w0 * o0 + w1 * load(row + i)) / (w0 + w1));
      }
    }
    std::memcpy(out + r * columns, row, sizeof(float) * columns);
  }
}

}  // namespace
