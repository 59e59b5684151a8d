// A plane to spectral modes and back: products with the modes of both axes.
//
// Modes that share their symmetries form a class, and need only sums or differences of mirror images. Along the
// outer axis classes are the even and the odd frequencies of a ring with an even number of samples, each with
// symmetric and antisymmetric modes; along the inner axis symmetric and antisymmetric modes alone, as a class
// there should fill a vector.
#pragma once

#include "kernels.h"
#include "product.h"

namespace {

using deodar::PlaneModes;

inline int64_t padded(int64_t count) { return 16 * ((count + 15) / 16); }

inline int64_t sum(const int64_t* counts, int64_t classes) {
  int64_t total = 0;
  for (int64_t c = 0; c < classes; ++c) total += counts[c];
  return total;
}

inline Vector reversed(Vector x) {
#if defined(__AVX512F__)
  return __builtin_shufflevector(x, x, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
#elif defined(__AVX2__)
  return __builtin_shufflevector(x, x, 7, 6, 5, 4, 3, 2, 1, 0);
#else
  return __builtin_shufflevector(x, x, 3, 2, 1, 0);
#endif
}

// Sizes of a plane.
struct Plane {
  int64_t rows, columns, outer_classes;
  int64_t half, outer_kept, inner_kept;        // samples of half a ring, and of each class
  int64_t outer_modes, row, inner_row, modes_row;  // modes, and lengths of padded rows

  explicit Plane(const PlaneModes& p)
      : rows(p.rows), columns(p.columns), outer_classes(p.outer_classes),
        half(outer_classes == 4 ? rows / 2 : rows), outer_kept((half + 1) / 2), inner_kept((columns + 1) / 2),
        outer_modes(sum(p.outer, outer_classes)), row(padded(columns)), inner_row(padded(inner_kept)),
        modes_row(padded(p.inner[0]) + padded(p.inner[1])) {}

  int64_t folded() const { return outer_classes * outer_kept * row; }
  int64_t middle() const { return outer_modes * row; }
  int64_t halves() const { return 2 * outer_modes * inner_row; }
  int64_t modes() const { return outer_modes * modes_row; }
};

int64_t plane_scratch(const PlaneModes& p) {
  const Plane plane(p);
  return plane.folded() + plane.middle() + plane.halves() + plane.modes() + 64;
}

// The parts of the scratch memory of a transform, one after another.
struct Parts {
  float* folded;        // for each outer class the sums or differences of rows
  float* middle;        // a row of samples for each outer mode
  float* sums;          // of the two halves of each such row
  float* differences;
  float* found;         // a row of modes for each outer mode, the two inner classes one after another

  Parts(const Plane& p, float* scratch)
      : folded(scratch), middle(folded + p.folded()), sums(middle + p.middle()), differences(sums + p.halves() / 2),
        found(sums + p.halves()) {}
};

// Sums and differences of the rows that are images of each other, each in the part of its class.
template <typename Number>
inline void fold_rows(const Plane& p, int64_t j, int64_t at, const float* y, float* folded) {
  auto read = [&](int64_t i) { Number x; std::memcpy(&x, y + i * p.columns + at, sizeof(x)); return x; };
  auto write = [&](int64_t c, Number x) {
    std::memcpy(folded + (c * p.outer_kept + j) * p.row + at, &x, sizeof(x));
  };
  const Number a = read(j), b = read(p.half - 1 - j);
  if (p.outer_classes == 2) {
    write(0, a + b);
    write(1, a - b);
    return;
  }
  const Number c = read(p.half + j), d = read(p.rows - 1 - j);
  const Number even = a + c, even_image = b + d, odd = a - c, odd_image = b - d;
  write(0, even + even_image);
  write(1, even - even_image);
  write(2, odd + odd_image);
  write(3, odd - odd_image);
}

template <typename Number>
inline void unfold_rows(const Plane& p, int64_t j, int64_t at, const float* folded, float* y) {
  auto read = [&](int64_t c) {
    Number x;
    std::memcpy(&x, folded + (c * p.outer_kept + j) * p.row + at, sizeof(x));
    return x;
  };
  auto write = [&](int64_t i, Number x) { std::memcpy(y + i * p.columns + at, &x, sizeof(x)); };
  const Number first = read(0) + read(1), image = read(0) - read(1);
  const bool middle = j == p.half - 1 - j;  // its own image
  if (p.outer_classes == 2) {
    write(j, first);
    if (!middle) write(p.half - 1 - j, image);
    return;
  }
  const Number odd = read(2) + read(3), odd_image = read(2) - read(3);
  write(j, first + odd);
  write(p.half + j, first - odd);
  if (middle) return;
  write(p.half - 1 - j, image + odd_image);
  write(p.rows - 1 - j, image - odd_image);
}

void plane_to_modes(const PlaneModes& modes, const float* y, float* scratch, float* out) {
  const Plane p(modes);
  const auto [folded, middle, sums, differences, found] = Parts(p, scratch);
  for (int64_t j = 0; j < p.outer_kept; ++j) {
    int64_t at = 0;
    for (; at + LANES <= p.columns; at += LANES) fold_rows<Vector>(p, j, at, y, folded);
    for (; at < p.columns; ++at) fold_rows<float>(p, j, at, y, folded);
  }
  // outer axis
  const float* table = modes.outer_table;
  float* to = middle;
  for (int64_t c = 0; c < p.outer_classes; ++c) {
    const int64_t count = modes.outer[c];
    product(count, vectors_of(p.columns), p.outer_kept, {table, 1, count}, folded + c * p.outer_kept * p.row, p.row,
            to, p.row);
    table += p.outer_kept * count;
    to += count * p.row;
  }
  // inner axis: rows of sums, then rows of differences
  const int64_t pairs = p.columns / 2;
  for (int64_t i = 0; i < p.outer_modes; ++i) {
    const float* from = middle + i * p.row;
    float* s = sums + i * p.inner_row;
    float* d = differences + i * p.inner_row;
    int64_t j = 0;
    for (; j + LANES <= pairs; j += LANES) {
      const Vector a = load(from + j), b = reversed(load(from + p.columns - LANES - j));
      store(s + j, a + b);
      store(d + j, a - b);
    }
    for (; j < p.inner_kept; ++j) {
      s[j] = from[j] + from[p.columns - 1 - j];
      d[j] = from[j] - from[p.columns - 1 - j];
    }
  }
  const int64_t first = padded(modes.inner[0]), second = padded(modes.inner[1]);
  product(p.outer_modes, vectors_of(modes.inner[0]), p.inner_kept, {sums, p.inner_row, 1}, modes.inner_table, first,
          found, p.modes_row);
  product(p.outer_modes, vectors_of(modes.inner[1]), p.inner_kept, {differences, p.inner_row, 1},
          modes.inner_table + p.inner_kept * first, second, found + first, p.modes_row);
  for (int64_t i = 0; i < p.outer_modes; ++i) {
    const float* from = found + i * p.modes_row;
    float* row = out + modes.outer_places[i] * modes.inner_count;
    const int32_t* places = modes.inner_places;
    for (int64_t j = 0; j < modes.inner[0]; ++j) row[places[j]] = from[j];
    for (int64_t j = 0; j < modes.inner[1]; ++j) row[places[modes.inner[0] + j]] = from[first + j];
  }
}

void plane_from_modes(const PlaneModes& modes, const float* given, float* scratch, float* y) {
  const Plane p(modes);
  const auto [folded, middle, sums, differences, found] = Parts(p, scratch);
  const int64_t first = padded(modes.inner[0]);
  for (int64_t i = 0; i < p.outer_modes; ++i) {
    float* to = found + i * p.modes_row;
    const float* row = given + modes.outer_places[i] * modes.inner_count;
    const int32_t* places = modes.inner_places;
    for (int64_t j = 0; j < modes.inner[0]; ++j) to[j] = row[places[j]];
    for (int64_t j = 0; j < modes.inner[1]; ++j) to[first + j] = row[places[modes.inner[0] + j]];
  }
  // inner axis
  product(p.outer_modes, vectors_of(p.inner_kept), modes.inner[0], {found, p.modes_row, 1}, modes.inner_table,
          p.inner_row, sums, p.inner_row);
  product(p.outer_modes, vectors_of(p.inner_kept), modes.inner[1], {found + first, p.modes_row, 1},
          modes.inner_table + modes.inner[0] * p.inner_row, p.inner_row, differences, p.inner_row);
  const int64_t pairs = p.columns / 2;
  for (int64_t i = 0; i < p.outer_modes; ++i) {
    const float* s = sums + i * p.inner_row;
    const float* d = differences + i * p.inner_row;
    float* to = middle + i * p.row;
    int64_t j = 0;
    for (; j + LANES <= pairs; j += LANES) {
      const Vector a = load(s + j), b = load(d + j);
      store(to + j, a + b);
      store(to + p.columns - LANES - j, reversed(a - b));
    }
    for (; j < p.inner_kept; ++j) {
      to[p.columns - 1 - j] = s[j] - d[j];
      to[j] = s[j] + d[j];
    }
  }
  // outer axis
  const float* table = modes.outer_table;
  const float* from = middle;
  for (int64_t c = 0; c < p.outer_classes; ++c) {
    const int64_t count = modes.outer[c];
    product(p.outer_kept, vectors_of(p.columns), count, {table, 1, p.outer_kept}, from, p.row,
            folded + c * p.outer_kept * p.row, p.row);
    table += p.outer_kept * count;
    from += count * p.row;
  }
  for (int64_t j = 0; j < p.outer_kept; ++j) {
    int64_t at = 0;
    for (; at + LANES <= p.columns; at += LANES) unfold_rows<Vector>(p, j, at, folded, y);
    for (; at < p.columns; ++at) unfold_rows<float>(p, j, at, folded, y);
  }
}

}  // namespace
