/* Chooses the copies of the vector kernels (src/friction_*_kernel.f90) for the
 * processor at hand. Empty where the build makes no copies: then the kernels themselves bear the names. */
#include <stdint.h>

#ifdef STICKSLIP_VECTOR_KERNELS

typedef void batch_kernel(const void *task, const double *constants, const double *du, double *statev,
                          double *traction, double *tangent, int *left, int *n_left);
typedef void slip_rate_kernel(int evolution, double damping, int64_t stride, const double *tau, const double *pressure,
                              const double *theta, const double *constants, double *rates, int *left);

typedef void subloading_kernel(int64_t stride, const double *du, double dtime, const double *constants, double *statev,
                               double *traction, double *tangent, int *left, int *n_left);

batch_kernel stickslip_batch_kernel, stickslip_batch_kernel_sse2, stickslip_batch_kernel_avx2,
    stickslip_batch_kernel_avx512;
slip_rate_kernel stickslip_slip_rate_kernel, stickslip_slip_rate_kernel_sse2, stickslip_slip_rate_kernel_avx2,
    stickslip_slip_rate_kernel_avx512;

typedef void constants_kernel(const void *source, int64_t stride, int count, const double *props, double *constants,
                              int *options, int *left);

constants_kernel stickslip_constants_kernel, stickslip_constants_kernel_sse2, stickslip_constants_kernel_avx2,
    stickslip_constants_kernel_avx512;

enum instruction_set { SSE2, AVX2, AVX512 };

#ifndef STICKSLIP_AT_MOST   /* tests try the lesser copies, too */
#define STICKSLIP_AT_MOST AVX512
#endif

static enum instruction_set best_instructions(void)
{
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")
        && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd"))
        return AVX512;
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? AVX2 : SSE2;
}

static enum instruction_set instructions(void)
{
    enum instruction_set best = best_instructions();

    return best < STICKSLIP_AT_MOST ? best : STICKSLIP_AT_MOST;
}

subloading_kernel stickslip_subloading_kernel, stickslip_subloading_kernel_sse2, stickslip_subloading_kernel_avx2,
    stickslip_subloading_kernel_avx512;

void stickslip_subloading_kernel(int64_t stride, const double *du, double dtime, const double *constants,
                                 double *statev, double *traction, double *tangent, int *left, int *n_left)
{
    static subloading_kernel *const copies[] = {stickslip_subloading_kernel_sse2, stickslip_subloading_kernel_avx2,
                                                stickslip_subloading_kernel_avx512};
    copies[instructions()](stride, du, dtime, constants, statev, traction, tangent, left, n_left);
}

void stickslip_batch_kernel(const void *task, const double *constants, const double *du, double *statev,
                            double *traction, double *tangent, int *left, int *n_left)
{
    static batch_kernel *const copies[] = {stickslip_batch_kernel_sse2, stickslip_batch_kernel_avx2,
                                           stickslip_batch_kernel_avx512};
    copies[instructions()](task, constants, du, statev, traction, tangent, left, n_left);
}

typedef void points_kernel_in(const double *du, const double *statev, double *du_block, double *statev_block);
typedef void points_kernel_out(const double *statev_block, const double *traction_block, const double *tangent_block,
                               double *statev, double *traction, double *tangent);

points_kernel_in stickslip_points_kernel_in, stickslip_points_kernel_sse2_in, stickslip_points_kernel_avx2_in,
    stickslip_points_kernel_avx512_in;
points_kernel_out stickslip_points_kernel_out, stickslip_points_kernel_sse2_out, stickslip_points_kernel_avx2_out,
    stickslip_points_kernel_avx512_out;

void stickslip_points_kernel_in(const double *du, const double *statev, double *du_block, double *statev_block)
{
    static points_kernel_in *const copies[] = {stickslip_points_kernel_sse2_in, stickslip_points_kernel_avx2_in,
                                               stickslip_points_kernel_avx512_in};
    copies[instructions()](du, statev, du_block, statev_block);
}

void stickslip_points_kernel_out(const double *statev_block, const double *traction_block, const double *tangent_block,
                                 double *statev, double *traction, double *tangent)
{
    static points_kernel_out *const copies[] = {stickslip_points_kernel_sse2_out, stickslip_points_kernel_avx2_out,
                                                stickslip_points_kernel_avx512_out};
    copies[instructions()](statev_block, traction_block, tangent_block, statev, traction, tangent);
}

void stickslip_constants_kernel(const void *source, int64_t stride, int count, const double *props, double *constants,
                                int *options, int *left)
{
    static constants_kernel *const copies[] = {stickslip_constants_kernel_sse2, stickslip_constants_kernel_avx2,
                                               stickslip_constants_kernel_avx512};
    copies[instructions()](source, stride, count, props, constants, options, left);
}

void stickslip_slip_rate_kernel(int evolution, double damping, int64_t stride, const double *tau,
                                const double *pressure, const double *theta, const double *constants, double *rates,
                                int *left)
{
    static slip_rate_kernel *const copies[] = {stickslip_slip_rate_kernel_sse2, stickslip_slip_rate_kernel_avx2,
                                               stickslip_slip_rate_kernel_avx512};
    copies[instructions()](evolution, damping, stride, tau, pressure, theta, constants, rates, left);
}

#endif
