// Vectors of floats of the instruction set that a file is compiled for: the vector extension of GCC and Clang.
#pragma once

#include <cstdint>
#include <cstring>

namespace {

#if defined(__AVX512F__)
constexpr int LANES = 16;
constexpr int SUMS = 14;  // vectors that stay in registers beside what is added to them
#elif defined(__AVX2__)
constexpr int LANES = 8;
constexpr int SUMS = 10;
#else
constexpr int LANES = 4;
constexpr int SUMS = 10;
#endif

typedef float Vector __attribute__((vector_size(4 * LANES)));
typedef float AnyVector __attribute__((vector_size(4 * LANES), aligned(4)));

inline Vector load(const float* from) { return *reinterpret_cast<const AnyVector*>(from); }
inline Vector load_aligned(const float* from) { return *reinterpret_cast<const Vector*>(from); }
inline void store(float* to, Vector x) { *reinterpret_cast<AnyVector*>(to) = x; }
inline void store_aligned(float* to, Vector x) { *reinterpret_cast<Vector*>(to) = x; }
inline Vector all(float x) { return x - Vector{}; }

// The number of vectors that hold so many floats.
inline int64_t vectors_of(int64_t count) { return (count + LANES - 1) / LANES; }

}  // namespace
