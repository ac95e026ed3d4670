/* A host's arithmetic stays what it was when it loads the library and calls it: numbers below the
 * normal range are not flushed to zero. */
#include <dlfcn.h>
#include <float.h>
#include <stdio.h>

typedef int update_batch(long long n, int ndir, const double *du, double dtime, int nprops, const double *props,
                         int nstatv, double *statev, double *traction, double *tangent, int *status);

static int denormals_live(void)
{
    volatile double smallest = DBL_MIN;

    return smallest / 4 > 0 && (smallest / 4) * 4 == smallest;
}

int main(int argc, char **argv)
{
    enum { n = 512 };
    static double du[3 * n], statev[8 * n], traction[3 * n], tangent[9 * n];
    static int status[n];
    const double props[9] = {1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.3};
    void *library;
    update_batch *update;
    int i;

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
    *(void **)&update = dlsym(library, "friction_update_batch");
    for (i = 0; i < n; i++) {
        du[i] = -1e-3;
        du[n + i] = 1e-3 * i / n;
    }
    if (!update || update(n, 3, du, 0.1, 9, props, 8, statev, traction, tangent, status) != 0)
        return 2;
    if (!denormals_live()) {
        fprintf(stderr, "calling the library flushes denormals to zero\n");
        return 1;
    }
    return 0;
}
