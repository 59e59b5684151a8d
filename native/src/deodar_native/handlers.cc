// The functions that XLA calls, in its foreign function interface, and the choice of the kernels.
#include "kernels.h"

#include <cstring>
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
using Reals = ffi::Buffer<ffi::F32>;
using Numbers = ffi::ResultBuffer<ffi::F32>;

// The rows of a call: all combinations of the leading axes, which are those of `vmap`. An argument has these
// axes too; where one of them does not concern it, it has the length 1 there.
struct Rows {
  ffi::Span<const int64_t> lengths;  // of the result
  size_t axes;
  int64_t count = 1;

  // `own`: number of axes that the result of a single call has.
  Rows(ffi::Span<const int64_t> result, size_t own) : lengths(result), axes(result.size() - own) {
    for (size_t d = 0; d < axes; ++d) count *= lengths[d];
  }

  // The part of an argument that belongs to a row; a single call has an argument of `own` axes.
  template <ffi::DataType type>
  auto* of(const ffi::Buffer<type>& argument, int64_t row, size_t own) const {
    const auto dimensions = argument.dimensions();
    int64_t size = 1, place = 0;
    for (size_t d = axes; d < axes + own; ++d) size *= dimensions[d];
    for (size_t d = axes; d-- > 0;) {
      place += row % lengths[d] % dimensions[d] * size;
      size *= dimensions[d];
      row /= lengths[d];
    }
    return argument.typed_data() + place;
  }
};

// Cells of a row that one thread computes, about 20 us.
constexpr int64_t NOISE_PIECE = 16384;

// keys (..., 2), tick (...), start (...), drawn (..., 2, cells) -> (..., 2, cells), in the place of `drawn`
ffi::Error noise_handler(ffi::ThreadPool pool, Words keys, Words ticks, Words starts, Reals drawn, Numbers out) {
  const Rows rows(out->dimensions(), 2);
  const int64_t cells = out->dimensions().back(), pieces = (cells + NOISE_PIECE - 1) / NOISE_PIECE;
  const bool moved = drawn.typed_data() != out->typed_data();
  in_pieces(pool, rows.count * pieces, [&](int64_t piece) {
    const int64_t r = piece / pieces, from = piece % pieces * NOISE_PIECE;
    const int64_t count = cells - from < NOISE_PIECE ? cells - from : NOISE_PIECE;
    const uint32_t tick = *rows.of(ticks, r, 0);
    const int64_t even = 2 * r * cells + from, odd = even + cells;
    float* to = out->typed_data();
    if (tick % 2 == 0 || tick == *rows.of(starts, r, 0)) {
      kernels().noise(rows.of(keys, r, 1), tick / 2, from, to + even, to + odd, count);
    } else if (moved) {
      std::memcpy(to + even, drawn.typed_data() + even, sizeof(float) * count);
      std::memcpy(to + odd, drawn.typed_data() + odd, sizeof(float) * count);
    }
  });
  return ffi::Error::Success();
}

// keys (..., 2), block (...) -> (..., 2, cells)
ffi::Error bits_handler(Words keys, Words blocks, ffi::ResultBuffer<ffi::U32> out) {
  const Rows rows(out->dimensions(), 2);
  const int64_t cells = out->dimensions().back();
  for (int64_t r = 0; r < rows.count; ++r) {
    uint32_t* first = out->typed_data() + 2 * r * cells;
    kernels().bits(rows.of(keys, r, 1), *rows.of(blocks, r, 0), first, first + cells, cells);
  }
  return ffi::Error::Success();
}

// Memory of this thread, aligned for every vector; it stays until the thread ends.
float* scratch(int64_t floats) {
  struct alignas(64) Line {
    float values[16];
  };
  static thread_local std::vector<Line> memory;
  const size_t lines = static_cast<size_t>(floats) / 16 + 1;
  if (memory.size() < lines) memory.resize(lines);
  return memory.data()->values;
}

// weights (..., reach + 1), y (..., samples) -> (..., samples)
ffi::Error line_handler(Reals weights, Reals y, int64_t boundary, Numbers out) {
  const Rows rows(out->dimensions(), 1);
  const int64_t samples = y.dimensions().back(), reach = weights.dimensions().back() - 1;
  if (2 * reach >= samples)
    return ffi::Error::InvalidArgument("line: weights of lags that are less than half the number of samples");
  float* memory = scratch(kernels().line_scratch(samples, reach));
  for (int64_t r = 0; r < rows.count; ++r)
    kernels().line(rows.of(y, r, 1), static_cast<Boundary>(boundary), rows.of(weights, r, 1), samples, reach,
                   memory, out->typed_data() + r * samples);
  return ffi::Error::Success();
}

using Places = ffi::Buffer<ffi::S32>;
using Counts = ffi::Span<const int64_t>;

// y (..., rows, columns) -> (..., modes, modes), or back; tables and places are those of all rows
template <bool forward>
ffi::Error plane_handler(ffi::ThreadPool pool, Reals y, Reals outer, Reals inner, Places outer_places,
                         Places inner_places, Counts outer_counts, Counts inner_counts, Numbers out) {
  const Rows rows(out->dimensions(), 2);
  const auto given = y.dimensions(), result = out->dimensions();
  const auto samples = forward ? given : result, modes = forward ? result : given;
  const size_t last = samples.size() - 1;
  const PlaneModes plane = {samples[last - 1],
                            samples[last],
                            static_cast<int64_t>(outer_counts.size()),
                            outer_counts.begin(),
                            inner_counts.begin(),
                            outer_places.typed_data(),
                            inner_places.typed_data(),
                            modes[modes.size() - 1],
                            outer.typed_data(),
                            inner.typed_data()};
  const int64_t size = result[last - 1] * result[last];
  const bool gaps = forward && static_cast<int64_t>(outer_places.element_count() * inner_places.element_count()) < size;
  in_pieces(pool, rows.count, [&](int64_t r) {
    float* to = out->typed_data() + r * size;
    float* memory = scratch(kernels().plane_scratch(plane));
    if (gaps) std::memset(to, 0, sizeof(float) * size);
    (forward ? kernels().plane_to_modes : kernels().plane_from_modes)(plane, rows.of(y, r, 2), memory, to);
  });
  return ffi::Error::Success();
}

// u (..., samples) or (..., rows, columns), beta (...), threshold (...) -> as u
ffi::Error cells_handler(ffi::ThreadPool pool, Reals u, Reals betas, Reals thresholds, ffi::Span<const int64_t> around,
                         Numbers out) {
  const size_t axes = around.size();
  const Rows rows(out->dimensions(), axes);
  const auto lengths = out->dimensions();
  const int64_t columns = lengths.back(), lines = axes > 1 ? lengths[lengths.size() - 2] : 1;
  const bool periodic[2] = {around[0] != 0, around.back() != 0};
  in_pieces(pool, rows.count, [&](int64_t r) {
    const Logistic g = {*rows.of(betas, r, 0), *rows.of(thresholds, r, 0)};
    float* memory = scratch(kernels().cells_scratch(lines, columns));
    kernels().cells(rows.of(u, r, axes), lines, columns, periodic, g, memory, out->typed_data() + r * lines * columns);
  });
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
                                  .Arg<deodar::Words>()
                                  .Arg<deodar::Reals>()
                                  .Ret<ffi::Buffer<ffi::F32>>());
XLA_FFI_DEFINE_HANDLER_SYMBOL(deodar_bits, deodar::bits_handler,
                              ffi::Ffi::Bind().Arg<deodar::Words>().Arg<deodar::Words>().Ret<ffi::Buffer<ffi::U32>>());
XLA_FFI_DEFINE_HANDLER_SYMBOL(deodar_line, deodar::line_handler,
                              ffi::Ffi::Bind()
                                  .Arg<deodar::Reals>()
                                  .Arg<deodar::Reals>()
                                  .Attr<int64_t>("boundary")
                                  .Ret<ffi::Buffer<ffi::F32>>());
XLA_FFI_DEFINE_HANDLER_SYMBOL(deodar_cells, deodar::cells_handler,
                              ffi::Ffi::Bind()
                                  .Ctx<ffi::ThreadPool>()
                                  .Arg<deodar::Reals>()
                                  .Arg<deodar::Reals>()
                                  .Arg<deodar::Reals>()
                                  .Attr<ffi::Span<const int64_t>>("periodic")
                                  .Ret<ffi::Buffer<ffi::F32>>());
#define DEODAR_PLANE(name, forward)                                            \
  XLA_FFI_DEFINE_HANDLER_SYMBOL(name, deodar::plane_handler<forward>,          \
                                ffi::Ffi::Bind()                               \
                                    .Ctx<ffi::ThreadPool>()                    \
                                    .Arg<deodar::Reals>()                      \
                                    .Arg<deodar::Reals>()                      \
                                    .Arg<deodar::Reals>()                      \
                                    .Arg<deodar::Places>()                     \
                                    .Arg<deodar::Places>()                     \
                                    .Attr<deodar::Counts>("outer_counts")      \
                                    .Attr<deodar::Counts>("inner_counts")      \
                                    .Ret<ffi::Buffer<ffi::F32>>())
DEODAR_PLANE(deodar_to_modes, true);
DEODAR_PLANE(deodar_from_modes, false);
#pragma GCC visibility pop
