// The functions that XLA calls, in its foreign function interface, and the choice of the kernels.
#include "kernels.h"

#include <string>
#include <vector>

#include "pieces.h"
#include "xla/ffi/api/ffi.h"

namespace ffi = xla::ffi;

namespace deodar {

extern const Kernels kernels_plain;
#if defined(__x86_64__)
extern const Kernels kernels_avx2, kernels_avx512;
#endif

namespace {

// The widest of the sets called `name` (any, if it is empty) that this processor has.
const Kernels* found(const std::string& name) {
  std::vector<const Kernels*> able = {&kernels_plain};
#if defined(__x86_64__)
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (avx2) able.push_back(&kernels_avx2);
  if (avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    able.push_back(&kernels_avx512);
#endif
  if (name.empty()) return able.back();
  for (const Kernels* one : able)
    if (name == one->vectors) return one;
  return nullptr;
}

const Kernels* chosen = found("");

const Kernels& kernels() { return *chosen; }

using Words = ffi::Buffer<ffi::U32>;
using Numbers = ffi::ResultBuffer<ffi::F32>;

// Cells of a row that one thread computes, about 20 us.
constexpr int64_t NOISE_PIECE = 16384;

// keys (..., 2), blocks (...) -> (..., 2, cells): leading axes are those of `vmap`
ffi::Error noise_handler(ffi::ThreadPool pool, Words keys, Words blocks, Numbers out) {
  const int64_t rows = static_cast<int64_t>(blocks.element_count());
  if (static_cast<int64_t>(keys.element_count()) != 2 * rows)
    return ffi::Error::InvalidArgument("noise: one key of two words for each block");
  const int64_t cells = rows ? static_cast<int64_t>(out->element_count()) / (2 * rows) : 0;
  const int64_t pieces = (cells + NOISE_PIECE - 1) / NOISE_PIECE;
  in_pieces(pool, rows * pieces, [&](int64_t piece) {
    const int64_t r = piece / pieces, from = piece % pieces * NOISE_PIECE;
    const int64_t count = cells - from < NOISE_PIECE ? cells - from : NOISE_PIECE;
    float* even = out->typed_data() + 2 * r * cells + from;
    kernels().noise(keys.typed_data() + 2 * r, blocks.typed_data()[r], from, even, even + cells, count);
  });
  return ffi::Error::Success();
}

ffi::Error bits_handler(Words keys, Words blocks, ffi::ResultBuffer<ffi::U32> out) {
  const int64_t rows = static_cast<int64_t>(blocks.element_count());
  if (static_cast<int64_t>(keys.element_count()) != 2 * rows)
    return ffi::Error::InvalidArgument("bits: one key of two words for each block");
  const int64_t cells = rows ? static_cast<int64_t>(out->element_count()) / (2 * rows) : 0;
  for (int64_t r = 0; r < rows; ++r) {
    uint32_t* first = out->typed_data() + 2 * r * cells;
    kernels().bits(keys.typed_data() + 2 * r, blocks.typed_data()[r], first, first + cells, cells);
  }
  return ffi::Error::Success();
}

}  // namespace
}  // namespace deodar

#define DEODAR_EXPORTED extern "C" __attribute__((visibility("default")))

DEODAR_EXPORTED const char* deodar_vectors() { return deodar::kernels().vectors; }

// Whether this processor has the set called `name`, which is used from now on.
DEODAR_EXPORTED bool deodar_choose(const char* name) {
  const deodar::Kernels* wanted = deodar::found(name);
  if (wanted) deodar::chosen = wanted;
  return wanted != nullptr;
}

#pragma GCC visibility push(default)
XLA_FFI_DEFINE_HANDLER_SYMBOL(deodar_noise, deodar::noise_handler,
                              ffi::Ffi::Bind()
                                  .Ctx<ffi::ThreadPool>()
                                  .Arg<deodar::Words>()
                                  .Arg<deodar::Words>()
                                  .Ret<ffi::Buffer<ffi::F32>>());
XLA_FFI_DEFINE_HANDLER_SYMBOL(deodar_bits, deodar::bits_handler,
                              ffi::Ffi::Bind().Arg<deodar::Words>().Arg<deodar::Words>().Ret<ffi::Buffer<ffi::U32>>());
#pragma GCC visibility pop
