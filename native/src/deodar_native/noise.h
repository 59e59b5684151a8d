// Counter-based noise: Threefry-2x32 with 20 rounds (Salmon, Moraes, Dror & Shaw, 2011, SC'11) and the method
// of Box & Muller (1958). The same integers as deodar/numerics/noise.py, and the same polynomials; deviates
// differ by rounding. Plain loops without branches, which compilers turn into vectors.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace {

struct Words {
  uint32_t first, second;
};

inline uint32_t rotated(uint32_t word, int count) { return (word << count) | (word >> (32 - count)); }

inline Words threefry(uint32_t x0, uint32_t x1, uint32_t k0, uint32_t k1) {
  constexpr int turns[2][4] = {{13, 15, 26, 6}, {17, 29, 16, 24}};
  const uint32_t keys[3] = {k0, k1, k0 ^ k1 ^ 0x1BD11BDAu};
  x0 += keys[0];
  x1 += keys[1];
#pragma GCC unroll 5
  for (int group = 0; group < 5; ++group) {
#pragma GCC unroll 4
    for (int turn = 0; turn < 4; ++turn) {
      x0 += x1;
      x1 = rotated(x1, turns[group % 2][turn]) ^ x0;
    }
    x0 += keys[(group + 1) % 3];
    x1 += keys[(group + 2) % 3] + static_cast<uint32_t>(group + 1);
  }
  return {x0, x1};
}

template <typename To, typename From>
inline To reinterpreted(From value) {
  static_assert(sizeof(To) == sizeof(From), "equal sizes");
  To out;
  std::memcpy(&out, &value, sizeof(To));
  return out;
}

// A uniform number in (0, 1) from the upper 23 bits, exact.
inline float uniform(uint32_t word) {
  return reinterpreted<float>((word >> 9) | 0x3F800000u) - 0.99999994f;  // 1 - 2^-24
}

// Natural logarithm of a number in (0, 1]: exponent and a polynomial on [0.75, 1.5).
inline float logarithm(float x) {
  const int32_t word = reinterpreted<int32_t>(x);
  const int32_t exponent = (word - 0x3F400000) >> 23;
  const float m = reinterpreted<float>(word - static_cast<int32_t>(static_cast<uint32_t>(exponent) << 23)) - 1.0f;
  float p = 0.0754f;
  p = p * m - 0.1584f;
  p = p * m + 0.20685f;
  p = p * m - 0.2519f;
  p = p * m + 0.3335f;
  p = p * m - 0.4999706f;
  p = p * m + 0.9999990f;
  return m * p + static_cast<float>(exponent) * 0.69314718f;
}

// sin(2 pi q) for q in [-1/4, 1/4].
inline float sine_of_turn(float q) {
  const float z = q * q;
  float p = 42.0f;
  p = p * z - 76.70f;
  p = p * z + 81.60523f;
  p = p * z - 41.341675f;
  p = p * z + 6.2831853f;
  return q * p;
}

void bits(const uint32_t* key, uint32_t block, uint32_t* first, uint32_t* second, int64_t cells) {
  const uint32_t k0 = key[0], k1 = key[1];
  for (int64_t i = 0; i < cells; ++i) {
    const Words words = threefry(static_cast<uint32_t>(i), block, k0, k1);
    first[i] = words.first;
    second[i] = words.second;
  }
}

void noise(const uint32_t* key, uint32_t block, int64_t from, float* __restrict even, float* __restrict odd,
           int64_t cells) {
  const uint32_t k0 = key[0], k1 = key[1];
  for (int64_t i = 0; i < cells; ++i) {
    const Words words = threefry(static_cast<uint32_t>(from + i), block, k0, k1);
    const float squared = -2.0f * logarithm(uniform(words.first));
    const float radius = std::sqrt(squared > 0.0f ? squared : 0.0f);
    const float t = uniform(words.second) - 0.5f, a = std::fabs(t);
    const float folded = a > 0.25f ? 0.5f - a : a;
    even[i] = -radius * sine_of_turn(std::copysign(folded, t));
    odd[i] = -radius * sine_of_turn(0.25f - a);
  }
}

}  // namespace
