/* Files of fields. Who lays them out (HDF5, or else nothing but numbers in a row: chosen when the
 * program is built) says where the numbers go, and the processes write them there side by side. */
#ifndef STICKSLIP_FIELD_LAYOUT_H
#define STICKSLIP_FIELD_LAYOUT_H
#include <stdint.h>

enum { name_length = 16, most_fields = 8 };

/* Fields on cells in rows and columns, at several times; type field_layout of field_file.f90. */
typedef struct {
    int64_t records;                        /* times */
    int64_t rows, columns;                  /* of cells */
    int64_t fields;
    char names[most_fields][name_length];   /* of the fields */
    char axes[2][name_length];              /* of rows and columns */
} field_layout;

/* 1: HDF5, one file stands for all parts. 0: numbers in a row, each part for itself. */
int stickslip_fields_are_hdf5(void);

/* Makes a file for these records. places[0] is the byte where their times begin, places[k] that of
 * field k, which has records x rows x columns numbers of 64 bits. 0: done. */
int stickslip_lay_out_fields(const char *path, const field_layout *layout, int64_t *places);

/* Finds the same in a file that is there; its records are counted. 0: it fits the layout. */
int stickslip_find_fields(const char *path, field_layout *layout, int64_t *places);

/* Makes the file that shows all parts as one: part i, from 0, with its name at parts + i*length,
 * holds records i*per_part + 1 and on. axes: places of the rows, then of the columns. 0: done. */
int stickslip_join_fields(const char *path, const field_layout *layout, const char *parts,
                          int64_t length, int64_t per_part, const double *axes);

/* Writes blocks of numbers into a file that is there, or reads them: `length` numbers from byte
 * `place` on, then `stride` bytes further. 0: all of them. */
int stickslip_put_numbers(const char *path, int64_t place, int64_t stride, int64_t blocks,
                          int64_t length, const double *numbers);
int stickslip_get_numbers(const char *path, int64_t place, int64_t stride, int64_t blocks,
                          int64_t length, double *numbers);
#endif
