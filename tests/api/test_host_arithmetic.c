/* A host's arithmetic stays what it was when it loads the library and calls it: numbers below the
 * normal range are not flushed to zero, and no exception is raised that a host might trap. */
#include <dlfcn.h>
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef int update_batch(int64_t n, int ndir, const double *du, double dtime, int nprops, const double *props,
                         int nstatv, double *statev, double *traction, double *tangent, int *status);
typedef int update(int ndir, const double *du, double dtime, int nprops, const double *props, int nstatv,
                   double *statev, double *traction, double *tangent);

enum { n = 1024, increments = 6, laws = 8, most_props = 14 };
static double du[3 * n], statev[8 * n], traction[3 * n], tangent[9 * n];
static int status[n];
/* Laws without and with a cap, two coefficients, cohesion, a damper. */
static const double props[laws][most_props] = {
    {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3},
    {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3, 0, 0, 1.5},
    {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3, 1, 0, 0, 0.6, 1},
    {2, 1000, 800, 0.45, 1.5, 0.6, 1, 0.2, 3},
    {3, 1000, 800, 0.45, 0.25, 0.1, 1.5},
    {4, 1000, 800, 0.02, 0.015, 1e-2, 1e-2, 0.4, 1, 0.1, 1.5},
    {5, 1000, 800, 0.45, 0.25, 0.1, 1.5},
    {8, 1000, 800, 0.02, 0.015, 1e-2, 1e-2, 0.4, 0.1, 0, 0.1, 1.5}};
static const int nprops[laws] = {9, 12, 14, 9, 7, 11, 7, 12};

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

/* Exceptions that batches, or the same points one by one, raise under a law. */
static int exceptions(update_batch *batch, update *one, int law, double dt)
{
    const int serious = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
    int raised = 0, k, i, j;

    memset(statev, 0, sizeof statev);
    for (k = 0; k < increments; k++) {
        random_increment();
        feclearexcept(FE_ALL_EXCEPT);
        batch(n, 3, du, dt, nprops[law], props[law], 8, statev, traction, tangent, status);
        raised |= fetestexcept(serious);
        feclearexcept(FE_ALL_EXCEPT);
        for (i = 0; i < n; i++) {
            double s[8], d[3], t[3], c[9];

            for (j = 0; j < 8; j++)
                s[j] = statev[j * n + i];
            for (j = 0; j < 3; j++)
                d[j] = du[j * n + i];
            one(3, d, dt, nprops[law], props[law], 8, s, t, c);
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
    int raised, law;

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
    for (law = 0; law < laws; law++) {
        raised = exceptions(batch, one, law, 0.1) | exceptions(batch, one, law, 1e-310);
        if (raised) {
            fprintf(stderr, "constants %d: floating-point exceptions are raised: batch %x, one point %x\n", law,
                    raised & 0xffff, raised >> 16);
            return 1;
        }
    }
    if (!denormals_live()) {
        fprintf(stderr, "calling the library flushes denormals to zero\n");
        return 1;
    }
    return 0;
}
