/* The shared objects for hosts allocate nothing in an update: counts the calls of malloc while UMAT is called
 * in stick, slip and opening. Arguments: the shared objects that have a umat_. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

static long calls;

void *malloc(size_t size)
{
    calls++;
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    calls++;
    return __libc_calloc(count, size);
}

void *realloc(void *old, size_t size)
{
    calls++;
    return __libc_realloc(old, size);
}

typedef void umat_function(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd,
                           double *rpl, double *ddsddt, double *drplde, double *drpldt, double *stran, double *dstran,
                           double *time, double *dtime, double *temp, double *dtemp, double *predef, double *dpred,
                           char *cmname, int *ndi, int *nshr, int *ntens, int *nstatv, double *props, int *nprops,
                           double *coords, double *drot, double *pnewdt, double *celent, double *dfgrd0,
                           double *dfgrd1, int *noel, int *npt, int *layer, int *kspt, int *jstep, int *kinc,
                           size_t cmname_length);

/* Pressed, sheared until it slides, and lifted; with and without large displacements, in and out of a perturbation. */
static long calls_of(umat_function *umat, double *props, int nprops, double scale)
{
    static const double path[][2] = {{-0.02, 0}, {0, 1e-3}, {0, 0.1}, {0, 0.1}, {0, -0.1}, {0.05, 0}};
    double statev[8], stress[6], ddsdde[36], zero[9] = {0}, dstran[6], stran[6], dtime = 0.1, pnewdt;
    char name[80];
    int three = 3, six = 6, eight = 8, one = 1, step[4] = {1, 1, 0, 0}, i, k, way;

    memset(name, ' ', sizeof name);
    memcpy(name, "@ABAQUS_STICKSLIP", 17);
    calls = 0;
    for (way = 0; way < 4; way++) {
        memset(statev, 0, sizeof statev);
        memset(stress, 0, sizeof stress);
        memset(stran, 0, sizeof stran);
        step[2] = way % 2;
        step[3] = way / 2;
        for (k = 0; k < (int)(sizeof path / sizeof *path); k++) {
            memset(dstran, 0, sizeof dstran);
            dstran[2] = scale * path[k][0];
            dstran[5] = scale * path[k][1];
            pnewdt = -1;
            umat(stress, statev, ddsdde, zero, zero, zero, zero, zero, zero, zero, stran, dstran, zero, &dtime, zero, zero,
                 zero, zero, name, &three, &three, &six, &eight, props, &nprops, zero, zero, &pnewdt, zero, zero, zero,
                 &one, &one, &one, &one, step, &one, sizeof name);
            for (i = 0; i < 6; i++)
                stran[i] += dstran[i];
        }
    }
    return calls;
}

int main(int n, char **names)
{
    /* a layer, then subloading friction with all its options; without the layer, for Kratos */
    double props[18] = {0.1, 1, 1, 1000, 800, 0.45, 0.25, 8, 0.2, 60, 0.4, 1, 0, 2, 0.8, 0, 0.1, 1};
    int failed = n < 3, k;
    void *volatile own = malloc(1);

    free(own);
    if (calls == 0) {
        puts("allocations are not seen");
        return 1;
    }
    for (k = 1; k < n; k++) {
        void *library = dlopen(names[k], RTLD_NOW), *symbol = library ? dlsym(library, "umat_") : NULL;
        int bare = strstr(names[k], "kratos") != NULL;
        umat_function *umat;
        long found;

        if (symbol == NULL) {
            printf("%s has no umat_\n", names[k]);
            return 1;
        }
        memcpy(&umat, &symbol, sizeof umat);
        found = calls_of(umat, bare ? props + 2 : props, bare ? 16 : 18, bare ? 0.1 : 1);
        printf("%s: %ld allocations\n", names[k], found);
        failed += found != 0;
    }
    return failed != 0;
}
