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
typedef int tangential(int ndir, const double *du, double pressure, double dtime, int nprops, const double *props,
                       int nstatv, double *statev, double *tau, double *dtau_ddu, double *dtau_dp);
typedef int continuous(int ndir, const double *velocity, int nprops, const double *props, int nstatv,
                       const double *statev, double *rates);
typedef int slip_rates(int64_t n, const double *tau, const double *pressure, double damping, int nprops,
                       const double *props, const double *internal, double *rate, double *internal_rate, int *status);

static update *one;
static update_batch *batch, *batch_props, *batch_points;
static tangential *given;
static continuous *rates_of;
static slip_rates *slip_rates_of;

enum { n = 512, increments = 4, laws = 15, most_props = 16 };
static double du[3 * n], statev[8 * n], traction[3 * n], tangent[9 * n], constants[most_props * n];
static double numbers[2][n];
static int status[n];
/* Every law, some without and with a cap, two coefficients, cohesion, a damper. */
static const double props[laws][most_props] = {
    {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3},
    {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3, 0, 0, 1.5},
    {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3, 0, 1},
    {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3, 0, 2},
    {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3, 0, 2, 0, 0.6, 1, 0.4, 0.1},
    {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3, 1, 0, 0, 0.6, 1},
    {2, 1000, 800, 0.45, 1.5, 0.6, 1, 0.2, 3},
    {3, 1000, 800, 0.45, 0.25, 0.1, 1.5},
    {4, 1000, 800, 0.02, 0.015, 1e-2, 1e-2, 0.4, 1, 0.1, 1.5},
    {4, 1000, 800, 0.02, 0.015, 1e-2, 1e-2, 0.4, 1, 1},
    {5, 1000, 800, 0.45, 0.25, 0.1, 1.5},
    {6, 1000, 800, 0.45, 0.25, 0.1, 0.2},
    {7, 1000, 800, 0.02, 0.015, 1e-2, 1e-2, 0.4, 0.1, 1},
    {8, 1000, 800, 0.02, 0.015, 1e-2, 1e-2, 0.4, 0.1},
    {8, 1000, 800, 0.02, 0.015, 1e-2, 1e-2, 0.4, 0.1, 0, 0.1, 1.5}};
static const int nprops[laws] = {9, 12, 11, 11, 16, 14, 9, 7, 11, 10, 7, 7, 10, 9, 12};

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
static void random_increment(double decades)
{
    int i;

    for (i = 0; i < n; i++) {
        double size = pow(10, -6 + (6 + decades) * draw());

        du[i] = (draw() - 0.6) * 1e-2;
        du[n + i] = draw() < 0.1 ? 0 : (draw() - 0.5) * size;
        du[2 * n + i] = draw() < 0.1 ? 0 : (draw() - 0.5) * size;
        if (draw() < 1e-3)
            du[n + i] = NAN;
    }
}

static int raised(void)
{
    int flags = fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);

    feclearexcept(FE_ALL_EXCEPT);
    return flags;
}

/* The same points in the entries that take one. */
static int one_by_one(int law, double dt)
{
    int flags = 0, i, j;

    for (i = 0; i < n; i++) {
        double s[8], d[3], t[3], c[9], q[2];
        const double pressure = (draw() - 0.1) * 20;

        for (j = 0; j < 3; j++)
            d[j] = du[j * n + i];
        for (j = 0; j < 8; j++)
            s[j] = statev[j * n + i];
        rates_of(3, d, nprops[law], props[law], 8, s, c);
        flags |= raised();
        given(2, d + 1, pressure, dt, nprops[law], props[law], 8, s, t, c, q);
        flags |= raised();
        for (j = 0; j < 8; j++)
            s[j] = statev[j * n + i];
        one(3, d, dt, nprops[law], props[law], 8, s, t, c);
        flags |= raised();
    }
    return flags;
}

/* Points in C order, constants of each point, slip rates of those points. */
static int by_points(int law, double dt)
{
    double d[3 * n], s[8 * n];
    int flags, i, j;

    for (i = 0; i < n; i++) {
        for (j = 0; j < 3; j++)
            d[3 * i + j] = du[j * n + i];
        for (j = 0; j < 8; j++)
            s[8 * i + j] = statev[j * n + i];
        numbers[0][i] = fabs(du[n + i]) * 1e3;
        numbers[1][i] = draw() < 0.1 ? 0 : draw() * 10;
        for (j = 0; j < nprops[law]; j++)
            constants[j * n + i] = props[law][j];
    }
    raised();
    batch_points(n, 3, d, dt, nprops[law], props[law], 8, s, traction, tangent, status);
    slip_rates_of(n, numbers[0], numbers[1], 1e-2, nprops[law], constants, statev + 5 * n, traction, tangent, status);
    memcpy(s, statev, sizeof s);
    batch_props(n, 3, du, dt, nprops[law], constants, 8, s, traction, tangent, status);
    flags = raised();
    return flags;
}

/* Exceptions that entries raise under a law: of batches; of points one by one, 16 bits higher. */
static int exceptions(int law, double dt, double decades)
{
    int flags = 0, k;

    memset(statev, 0, sizeof statev);
    for (k = 0; k < increments; k++) {
        random_increment(decades);
        raised();
        flags |= one_by_one(law, dt) << 16;
        flags |= by_points(law, dt);
        batch(n, 3, du, dt, nprops[law], props[law], 8, statev, traction, tangent, status);
        flags |= raised();
    }
    return flags;
}

/* Every entry of the library; 0 if one is missing. */
static int find_entries(void *library)
{
    *(void **)&one = dlsym(library, "friction_update");
    *(void **)&batch = dlsym(library, "friction_update_batch");
    *(void **)&batch_props = dlsym(library, "friction_update_batch_props");
    *(void **)&batch_points = dlsym(library, "friction_update_points");
    *(void **)&given = dlsym(library, "friction_tangential");
    *(void **)&rates_of = dlsym(library, "friction_rates");
    *(void **)&slip_rates_of = dlsym(library, "friction_slip_rates");
    return one && batch && batch_props && batch_points && given && rates_of && slip_rates_of;
}

int main(int argc, char **argv)
{
    void *library;
    int flags, law;

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
    if (!find_entries(library))
        return 2;
    for (law = 0; law < laws; law++) {
        flags = exceptions(law, 0.1, 0) | exceptions(law, 0.1, 18) | exceptions(law, 0.1, 90)
                | exceptions(law, 1e-13, 18) | exceptions(law, 1e-310, 0);
        if (flags) {
            fprintf(stderr, "constants %d: floating-point exceptions are raised: batches %x, one point %x\n", law,
                    flags & 0xffff, flags >> 16);
            return 1;
        }
    }
    if (!denormals_live()) {
        fprintf(stderr, "calling the library flushes denormals to zero\n");
        return 1;
    }
    return 0;
}
