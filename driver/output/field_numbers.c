/* Numbers at their places in a file of fields. Through the C library: gfortran's own output takes a
 * full disk for success. */
#include "field_layout.h"
#include <stdio.h>

int stickslip_put_numbers(const char *path, int64_t place, int64_t stride, int64_t blocks,
                          int64_t length, const double *numbers)
{
    size_t n = (size_t)length;
    FILE *file = fopen(path, "r+");
    if (file == NULL)
        return 1;
    int failed = 0;
    for (int64_t i = 0; i < blocks && !failed; i++)
        failed = fseek(file, (long)(place + i * stride), SEEK_SET) != 0
                 || fwrite(numbers + i * length, sizeof *numbers, n, file) != n;
    return fclose(file) != 0 || failed;
}

int stickslip_get_numbers(const char *path, int64_t place, int64_t stride, int64_t blocks,
                          int64_t length, double *numbers)
{
    size_t n = (size_t)length;
    FILE *file = fopen(path, "r");
    if (file == NULL)
        return 1;
    int failed = 0;
    for (int64_t i = 0; i < blocks && !failed; i++)
        failed = fseek(file, (long)(place + i * stride), SEEK_SET) != 0
                 || fread(numbers + i * length, sizeof *numbers, n, file) != n;
    fclose(file);
    return failed;
}
