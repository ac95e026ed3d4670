/* A host's arithmetic stays what it was when it loads the library and calls it: numbers below the
 * normal range are not flushed to zero, and no exception is raised that a host might trap. */
#include <dlfcn.h>
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>

typedef int update_batch(int64_t n, int ndir, const double *du, double dtime, int nprops, const double *props,
                         int nstatv, double *statev, double *traction, double *tangent, int *status);
typedef int update(int ndir, const double *du, double dtime, int nprops, const double *props, int nstatv,
                   double *statev, double *traction, double *tangent);

enum { n = 4096, increments = 6 };
static double du[3 * n], statev[8 * n], traction[3 * n], tangent[9 * n];
static int status[n];
static const double props[9] = {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3};

static int denormals_live(void)
{
    volatile double smallest = DBL_MIN;

    return smallest / 4 > 0 && (smallest / 4) * 4 == smallest;
}

static double draw(void)
{
    static uint64_t x = 88172645463325252u;

    x ^= x << 13;
    x ^= x >> 7;
    x ^= x << 17;
    return (double)(x >> 11) / 9007199254740992.0;
}

/* Pressed, lifted, moved far and not at all, and a few that are no numbers. */
static void random_increment(void)
{
    int i;

    for (i = 0; i < n; i++) {
        double size = pow(10, -6 * draw());

        du[i] = (draw() - 0.6) * 1e-2;
        du[n + i] = draw() < 0.1 ? 0 : (draw() - 0.5) * size;
        du[2 * n + i] = draw() < 0.1 ? 0 : (draw() - 0.5) * size;
        if (draw() < 1e-3)
            du[n + i] = NAN;
    }
}

/* Exceptions that batches, or the same points one by one, raise. */
static int exceptions(update_batch *batch, update *one)
{
    const int serious = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
    int raised = 0, k, i, j;

    for (k = 0; k < increments; k++) {
        random_increment();
        feclearexcept(FE_ALL_EXCEPT);
        batch(n, 3, du, 0.1, 9, props, 8, statev, traction, tangent, status);
        raised |= fetestexcept(serious);
        feclearexcept(FE_ALL_EXCEPT);
        for (i = 0; i < n; i++) {
            double s[8], d[3], t[3], c[9];

            for (j = 0; j < 8; j++)
                s[j] = statev[j * n + i];
            for (j = 0; j < 3; j++)
                d[j] = du[j * n + i];
            one(3, d, 0.1, 9, props, 8, s, t, c);
        }
        raised |= fetestexcept(serious) << 16;
    }
    return raised;
}

int main(int argc, char **argv)
{
    void *library;
    update_batch *batch;
    update *one;
    int raised;

    if (argc < 2 || !denormals_live())
        return 2;
    library = dlopen(argv[1], RTLD_NOW);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 2;
    }
    if (!denormals_live()) {
        fprintf(stderr, "loading the library flushes denormals to zero\n");
        return 1;
    }
    *(void **)&batch = dlsym(library, "friction_update_batch");
    *(void **)&one = dlsym(library, "friction_update");
    if (!batch || !one)
        return 2;
    raised = exceptions(batch, one);
    if (raised) {
        fprintf(stderr, "floating-point exceptions are raised: batch %x, one point %x\n", raised & 0xffff, raised >> 16);
        return 1;
    }
    if (!denormals_live()) {
        fprintf(stderr, "calling the library flushes denormals to zero\n");
        return 1;
    }
    return 0;
}
