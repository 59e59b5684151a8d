/* One step of one neural field in plain C, written by hand for vectors: what a careful programmer reaches on one core.
 *
 *     tau du/dt = -u + h + S + conv(k, g(u)) - c sum(g(u)) + q noise
 *
 * on a ring (or torus) with unit spacing, dt / tau = 1/20, a logistic g, two normalised Gaussians cut at 2.5 sigma, one Gaussian stimulus,
 * Euler's method in single precision. The convolution is direct and separable; in one dimension both kernels are one row of taps. The noise is
 * a 32-bit hash and Box-Muller's formula: cheaper than deodar's own generator, which has published test vectors and this has not.
 *
 * Sizes are constants of the program:
 *     cc -O3 -march=native -DN0=50 -DN1=50 -DN2=1 -DDIM=2 -DTRIALS=1 -DSIGMA_EXC=3 -DSIGMA_INH=6 yardstick.c -lm
 * It reads lines "STEPS NOISE" and answers each with the CPU seconds of so many steps from rest; noise is 1 or 0.
 * `yardstick state STEPS` writes the activation after so many steps without noise, float32, as it lies in memory;
 * `yardstick normals STEPS` the deviates of so many steps.
 */
#define _GNU_SOURCE
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

#define LANES 16
#define UP(n) (((n) + LANES - 1) / LANES * LANES)
#define CELLS (N0 * N1 * N2)
#define PADDED UP(CELLS)
#define LAST (DIM == 1 ? N0 : DIM == 2 ? N1 : N2) /* samples along the axis that is contiguous */
#define ROWS (CELLS / LAST)
#define MOST_TAPS 128
#define SLACK 256 /* what vectors at the end of an array may reach beyond it */

typedef float vf __attribute__((vector_size(4 * LANES)));
typedef float vf_at __attribute__((vector_size(4 * LANES), aligned(4)));
typedef int32_t vi __attribute__((vector_size(4 * LANES)));
typedef uint32_t vu __attribute__((vector_size(4 * LANES)));
typedef uint32_t vu_at __attribute__((vector_size(4 * LANES), aligned(4)));
#define INLINE static inline __attribute__((always_inline))
#define ALIGNED __attribute__((aligned(64)))

static const float STEP = 1.0f / 20, REST = -5, STEEPNESS = 4, EXCITATION = 15, INHIBITION = 8, GLOBAL = 0.1f, STRENGTH = 1;

typedef struct {
    int radius;
    float tap[MOST_TAPS];
} Taps;

static float u[TRIALS * PADDED] ALIGNED, input[PADDED] ALIGNED, g[TRIALS * PADDED + SLACK] ALIGNED, sum_in[TRIALS * PADDED + SLACK] ALIGNED;
static float second[TRIALS * PADDED] ALIGNED;
static uint32_t place[TRIALS * PADDED] ALIGNED;
static Taps kernels[2][DIM]; /* excitation and inhibition, along each axis */


INLINE vf all(float x) { return x - (vf){0}; }
INLINE vf load(const float *p) { return (vf) * (const vf_at *)p; }
INLINE void store(float *p, vf x) { *(vf_at *)p = (vf_at)x; }
INLINE vf choose(vi mask, vf yes, vf no) { return (vf)((mask & (vi)yes) | (~mask & (vi)no)); }

/* ------------------------------------------------------------------------------------------------ functions of vectors */

INLINE vf logistic(vf x) /* 1 / (1 + exp(-x)), with 2^f on [-1/2, 1/2] as a polynomial */
{
    vf t = x * all(-1.44269504f);
    t = choose(t > all(126), all(126), t);
    t = choose(t < all(-126), all(-126), t);
    vf shifted = t + all(12582912.0f); /* 1.5 * 2^23: the sum's last bits are the nearest whole number */
    vf f = t - (shifted - all(12582912.0f));
    vf p = all(1.3333558e-3f);
    p = p * f + all(9.6181291e-3f);
    p = p * f + all(5.5504109e-2f);
    p = p * f + all(2.4022651e-1f);
    p = p * f + all(6.9314718e-1f);
    p = p * f + all(1.0f);
    return all(1.0f) / (all(1.0f) + (vf)((vi)p + ((vi)shifted << 23)));
}

INLINE vf root(vf x)
{
#ifdef __AVX512F__
    return (vf)_mm512_sqrt_ps((__m512)x);
#else
    for (int k = 0; k < LANES; k++) x[k] = sqrtf(x[k]);
    return x;
#endif
}

INLINE vu mix(vu x) /* a bijection of 32 bits without visible structure */
{
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ (x >> 16);
}

static uint32_t mix_one(uint32_t x)
{
    vu v = {x};
    return mix(v)[0];
}

INLINE vf uniform(vu word) { return (vf)((word >> 9) | 0x3f800000U) - all(0.99999994f); } /* in (0, 1) */

INLINE vf minus_two_log(vf x) /* exponent and a polynomial on [3/4, 3/2) */
{
    vi word = (vi)x, exponent = (word - 0x3f400000) >> 23;
    vf m = (vf)(word - (exponent << 23)) - all(1.0f);
    vf p = all(-0.1508f);
    p = p * m + all(0.2158f);
    p = p * m + all(-0.2584f);
    p = p * m + all(0.3333f);
    p = p * m + all(-0.49993f);
    p = p * m + all(1.0f);
    vf y = all(-2.0f) * (m * p + __builtin_convertvector(exponent, vf) * all(0.69314718f));
    return choose(y > all(0), y, all(0));
}

INLINE vf sine(vf q) /* sin(2 pi q) for q in [-1/4, 1/4] */
{
    vf z = q * q, p = all(39.7107f);
    p = p * z + all(-76.5752f);
    p = p * z + all(81.6013f);
    p = p * z + all(-41.34165f);
    return q * (p * z + all(6.2831852f));
}

INLINE void normals(vu number, uint32_t step, vf *first, vf *other) /* two deviates of a pair of hashes */
{
    vu a = mix(number + step), b = mix(a ^ 0x9e3779b9U);
    vf radius = root(minus_two_log(uniform(a))), turn = uniform(b) - all(0.5f);
    vf size = (vf)((vi)turn & 0x7fffffff), sign = (vf)((vi)turn & (int32_t)0x80000000);
    vf fold = choose(size > all(0.25f), all(0.5f) - size, size);
    *first = radius * sine((vf)((vi)fold | (vi)sign));
    *other = radius * sine(all(0.25f) - size);
}

/* ------------------------------------------------------------------------------------------------ convolution */

/* `rows` rows of `width` vectors: sums over the taps of `x` at distances `stride`, in registers. */
INLINE void block(const float *x, long row_x, float *y, long row_y, const Taps *w, long stride, int rows, int width, int add)
{
    vf sum[8];
#pragma GCC unroll 8
    for (int k = 0; k < rows * width; k++) sum[k] = add ? load(y + k / width * row_y + k % width * LANES) : all(0);
    for (int j = 0; j <= 2 * w->radius; j++) {
        vf tap = all(w->tap[j]);
        const float *from = x + j * stride;
#pragma GCC unroll 8
        for (int k = 0; k < rows * width; k++) sum[k] += tap * load(from + k / width * row_x + k % width * LANES);
    }
#pragma GCC unroll 8
    for (int k = 0; k < rows * width; k++) store(y + k / width * row_y + k % width * LANES, sum[k]);
}

INLINE void rest(const float *x, float *y, int vectors, const Taps *w, long stride, int add) /* fewer than eight */
{
    switch (vectors) {
    case 7: block(x, 0, y, 0, w, stride, 1, 7, add); break;
    case 6: block(x, 0, y, 0, w, stride, 1, 6, add); break;
    case 5: block(x, 0, y, 0, w, stride, 1, 5, add); break;
    case 4: block(x, 0, y, 0, w, stride, 1, 4, add); break;
    case 3: block(x, 0, y, 0, w, stride, 1, 3, add); break;
    case 2: block(x, 0, y, 0, w, stride, 1, 2, add); break;
    case 1: block(x, 0, y, 0, w, stride, 1, 1, add); break;
    }
}

INLINE void line(const float *x, float *y, int cells, const Taps *w, long stride, int add)
{
    int vectors = UP(cells) / LANES, at = 0;
    for (; at + 8 <= vectors; at += 8) block(x + at * LANES, 0, y + at * LANES, 0, w, stride, 1, 8, add);
    rest(x + at * LANES, y + at * LANES, vectors - at, w, stride, add);
}

INLINE void wrap(float *padded, const float *x, long cells, long halo) /* a copy with its ends repeated beyond each other */
{
    memcpy(padded, x + cells - halo, halo * sizeof(float));
    if (x != padded + halo) memcpy(padded + halo, x, cells * sizeof(float));
    memcpy(padded + halo + cells, x, halo * sizeof(float));
}

/* Along the contiguous axis. Several short rows at once, so that enough sums are under way; rows are written in ascending order, because the
   last vector of each reaches into the next. */
static void along_rows(const float *x, float *y, int rows, const Taps *w)
{
    enum { WIDTH = UP(LAST) / LANES, TOGETHER = WIDTH >= 5 ? 1 : 8 / WIDTH, ROOM = UP(LAST + MOST_TAPS) + SLACK };
    static float padded[TOGETHER * ROOM] ALIGNED;
    int i = 0;
    for (; i + TOGETHER <= rows; i += TOGETHER) {
        for (int k = 0; k < TOGETHER; k++) wrap(padded + k * ROOM, x + (long)(i + k) * LAST, LAST, w->radius);
        if (TOGETHER > 1)
            block(padded, ROOM, y + (long)i * LAST, LAST, w, 1, TOGETHER, WIDTH <= 4 ? WIDTH : 1, 0);
        else
            line(padded, y + (long)i * LAST, LAST, w, 1, 0);
    }
    for (; i < rows; i++) {
        wrap(padded, x + (long)i * LAST, LAST, w->radius);
        line(padded, y + (long)i * LAST, LAST, w, 1, 0);
    }
}

/* Along an outer axis: its neighbours lie `stride` apart, so the array is one long line, without remainders at the ends of rows. The array is
   given with room for the halo before and behind. */
INLINE void along_outer(float *room, float *y, long cells, long stride, const Taps *w, int add)
{
    wrap(room, room + w->radius * stride, cells, w->radius * stride);
    line(room, y, cells, w, stride, add);
}

static void convolve(const float *from, float *to)
{
#if DIM == 1
    along_rows(from, to, 1, &kernels[0][0]);
#elif DIM == 2
    static float room[(N0 + MOST_TAPS) * N1 + SLACK] ALIGNED;
    for (int c = 0; c < 2; c++) {
        along_rows(from, room + kernels[c][0].radius * N1, N0, &kernels[c][1]);
        along_outer(room, to, CELLS, N1, &kernels[c][0], c > 0);
    }
#else
    enum { SLAB = N1 * N2 };
    static float slab[(N1 + MOST_TAPS) * N2 + SLACK] ALIGNED, room[(N0 + MOST_TAPS) * SLAB + SLACK] ALIGNED;
    for (int c = 0; c < 2; c++) {
        float *inside = room + kernels[c][0].radius * SLAB;
        for (int i = 0; i < N0; i++) {
            along_rows(from + (long)i * SLAB, slab + kernels[c][1].radius * N2, N1, &kernels[c][2]);
            along_outer(slab, inside + (long)i * SLAB, SLAB, N2, &kernels[c][1], 0);
        }
        along_outer(room, to, CELLS, SLAB, &kernels[c][0], c > 0);
    }
#endif
}

/* ------------------------------------------------------------------------------------------------ one step */

static float outputs(const float *v, float *out)
{
    vf total = all(0);
    for (int i = 0; i < PADDED; i += LANES) {
        vf y = logistic(all(STEEPNESS) * load(v + i));
        store(out + i, y);
        total += y;
    }
    float whole = 0;
    for (int k = 0; k < LANES; k++) whole += total[k];
    return whole;
}

INLINE void update(float *v, const float *sums, const uint32_t *numbers, float *kept, float level, uint32_t step, int noise)
{
    vf first = all(0), other;
    float amount = STRENGTH * STEP / sqrtf(20.0f * STEP); /* q sqrt(dt) / tau with dt = 1 */
    uint32_t word = mix_one(step / 2);
    for (int i = 0; i < PADDED; i += LANES) {
        vf x = load(v + i);
        x += all(STEP) * (load(input + i) + load(sums + i) + all(level) - x);
        if (noise == 1) { /* an even step: both deviates, the second for the next step */
            normals((vu) * (const vu_at *)(numbers + i), word, &first, &other);
            store(kept + i, other);
        } else if (noise == 2) {
            first = load(kept + i);
        }
        store(v + i, noise ? x + all(amount) * first : x);
    }
}

static void run(long steps, int noise)
{
    for (long i = 0; i < (long)TRIALS * PADDED; i++) u[i] = REST;
    for (long s = 0; s < steps; s++)
        for (int trial = 0; trial < TRIALS; trial++) {
            long at = (long)trial * PADDED;
            float level = REST - GLOBAL * outputs(u + at, g + at);
            convolve(g + at, sum_in + at);
            if (!noise)
                update(u + at, sum_in + at, place + at, second + at, level, s, 0);
            else if (s % 2 == 0)
                update(u + at, sum_in + at, place + at, second + at, level, s, 1);
            else
                update(u + at, sum_in + at, place + at, second + at, level, s, 2);
        }
}

/* ------------------------------------------------------------------------------------------------ set-up */

static Taps gaussian(float sigma, int samples, float amplitude)
{
    Taps w = {0};
    int most = (samples - 1) / 2, radius = (int)ceilf(2.5f * sigma);
    double total = 0;
    w.radius = radius < most ? radius : most;
    for (int j = -w.radius; j <= w.radius; j++) total += exp(-0.5 * j * j / (sigma * sigma));
    for (int j = -w.radius; j <= w.radius; j++) w.tap[j + w.radius] = (float)(amplitude * exp(-0.5 * j * j / (sigma * sigma)) / total);
    return w;
}

static void set_up(void)
{
    int size[3] = {N0, N1, N2};
    for (int d = 0; d < DIM; d++) {
        kernels[0][d] = gaussian(SIGMA_EXC, size[d], d ? 1 : EXCITATION);
        kernels[1][d] = gaussian(SIGMA_INH, size[d], d ? 1 : -INHIBITION);
    }
    if (DIM == 1) {
        Taps *wide = &kernels[1][0], *narrow = &kernels[0][0];
        for (int j = 0; j <= 2 * narrow->radius; j++) wide->tap[j + wide->radius - narrow->radius] += narrow->tap[j];
        *narrow = *wide;
    }
    for (int i = 0; i < PADDED; i++) {
        int x = i / (N1 * N2) - N0 / 2, y = i / N2 % N1 - N1 / 2, z = i % N2 - N2 / 2;
        input[i] = i < CELLS ? 6.0f * expf(-(x * x + y * y + z * z) / 18.0f) : -1000.0f; /* cells that only fill a vector stay silent */
    }
    for (long i = 0; i < (long)TRIALS * PADDED; i++) place[i] = mix_one((uint32_t)i * 0x9e3779b9U + 1u);
}

static double cpu(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
}

int main(int count, char **words)
{
    long steps;
    int noise;
    set_up();
    if (count == 3 && !strcmp(words[1], "state")) {
        run(atol(words[2]), 0);
        for (int trial = 0; trial < TRIALS; trial++) fwrite(u + (long)trial * PADDED, sizeof(float), CELLS, stdout);
        return 0;
    }
    if (count == 3 && !strcmp(words[1], "normals")) {
        for (steps = 0; steps < atol(words[2]); steps += 2) {
            vf both[2];
            for (int i = 0; i < PADDED; i += LANES) {
                normals((vu) * (const vu_at *)(place + i), mix_one(steps / 2), &both[0], &both[1]);
                fwrite(both, sizeof(vf), 2, stdout);
            }
        }
        return 0;
    }
    while (scanf("%ld %d", &steps, &noise) == 2) {
        double began = cpu();
        run(steps, noise);
        printf("%.9f\n", cpu() - began);
        fflush(stdout);
    }
    return 0;
}
