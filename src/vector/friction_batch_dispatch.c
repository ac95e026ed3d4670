/* Chooses the copy of the batch kernel (friction_batch_kernel.f90) for the processor at hand. Empty
 * where the build makes no copies: then the kernel itself bears the name. */
#include <stdint.h>

typedef void kernel(int64_t stride, const double *du, double dtime, const double *constants, double *statev,
                    double *traction, double *tangent, int *left, int *n_left);

#ifdef STICKSLIP_VECTOR_KERNELS

kernel stickslip_batch_kernel, stickslip_batch_kernel_sse2, stickslip_batch_kernel_avx2, stickslip_batch_kernel_avx512;

void stickslip_batch_kernel(int64_t stride, const double *du, double dtime, const double *constants, double *statev,
                           double *traction, double *tangent, int *left, int *n_left)
{
    kernel *chosen = stickslip_batch_kernel_sse2;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")
        && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd"))
        chosen = stickslip_batch_kernel_avx512;
    else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        chosen = stickslip_batch_kernel_avx2;
    chosen(stride, du, dtime, constants, statev, traction, tangent, left, n_left);
}

#endif
