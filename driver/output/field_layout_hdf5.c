/* Files of fields as HDF5. The library makes the files and tells where contiguous data sets begin
 * (H5Dget_offset); nothing of a file but its numbers is changed after it was closed. */
#include "field_layout.h"
#include <hdf5.h>
#include <string.h>

static const char *const times = "time";

int stickslip_fields_are_hdf5(void) { return 1; }

/* Shape of a data set: records, rows and, where there are several, columns. */
static int shape_of(const field_layout *layout, int field, hsize_t *shape)
{
    shape[0] = (hsize_t)layout->records;
    shape[1] = (hsize_t)layout->rows;
    shape[2] = (hsize_t)layout->columns;
    return field == 0 ? 1 : layout->columns > 1 ? 3 : 2;
}

static const char *name_of(const field_layout *layout, int field)
{
    return field == 0 ? times : layout->names[field - 1];
}

/* Files and data sets have no dates, so that equal runs leave equal files; the file's is that of its
 * root group, which HDF5 2 notes, too. */
static hid_t new_file(const char *path)
{
    hid_t properties = H5Pcreate(H5P_FILE_CREATE);
    H5Pset_obj_track_times(properties, 0);
    hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, properties, H5P_DEFAULT);
    H5Pclose(properties);
    return file;
}

static hid_t plain_properties(void)
{
    hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(properties, 0);
    return properties;
}

static hid_t new_set(hid_t file, const char *name, hid_t space, hid_t properties)
{
    return H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
}

int stickslip_lay_out_fields(const char *path, const field_layout *layout, int64_t *places)
{
    int failed = 0;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL); /* the caller tells what failed */
    hid_t file = new_file(path);
    if (file < 0)
        return 1;
    hid_t properties = plain_properties(); /* room is given out, and not filled */
    H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER);
    for (int k = 0; k <= layout->fields; k++) {
        hsize_t shape[3];
        int rank = shape_of(layout, k, shape);
        hid_t space = H5Screate_simple(rank, shape, NULL);
        hid_t set = new_set(file, name_of(layout, k), space, properties);
        places[k] = (int64_t)H5Dget_offset(set);
        failed |= set < 0 || H5Dget_offset(set) == HADDR_UNDEF;
        H5Dclose(set);
        H5Sclose(space);
    }
    H5Pclose(properties);
    return H5Fclose(file) < 0 || failed;
}

/* Does a data set of doubles lie in the file as laid out? Counts its records. */
static int is_laid_out(hid_t set, field_layout *layout, int field)
{
    hsize_t expected[3], found[H5S_MAX_RANK];
    int rank = shape_of(layout, field, expected);
    hid_t space = H5Dget_space(set), type = H5Dget_type(set);
    int fits = H5Sget_simple_extent_ndims(space) == rank && H5Tequal(type, H5T_NATIVE_DOUBLE) > 0;
    if (fits) {
        H5Sget_simple_extent_dims(space, found, NULL);
        if (field == 0)
            layout->records = (int64_t)found[0];
        else
            fits = memcmp(expected, found, rank * sizeof expected[0]) == 0;
    }
    H5Tclose(type);
    H5Sclose(space);
    return fits;
}

int stickslip_find_fields(const char *path, field_layout *layout, int64_t *places)
{
    int failed = 0;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0)
        return 1;
    for (int k = 0; k <= layout->fields && !failed; k++) {
        hid_t set = H5Dopen2(file, name_of(layout, k), H5P_DEFAULT);
        failed = set < 0;
        if (failed)
            break;
        places[k] = (int64_t)H5Dget_offset(set);
        failed = !is_laid_out(set, layout, k) || H5Dget_offset(set) == HADDR_UNDEF;
        H5Dclose(set);
    }
    H5Fclose(file);
    return failed;
}

/* A data set that is made of those of the parts. */
static int join_field(hid_t file, int field, const field_layout *layout, const char *parts,
                      int64_t length, int64_t per_part)
{
    hsize_t whole[3], part[3], start[3] = {0, 0, 0};
    const hsize_t origin[3] = {0, 0, 0};
    int failed = 0;
    int rank = shape_of(layout, field, whole);
    hid_t space = H5Screate_simple(rank, whole, NULL);
    hid_t properties = plain_properties();
    memcpy(part, whole, sizeof part);
    for (int64_t i = 0; i * per_part < layout->records; i++) {
        int64_t rest = layout->records - i * per_part;
        start[0] = (hsize_t)(i * per_part);
        part[0] = (hsize_t)(rest < per_part ? rest : per_part);
        hid_t source = H5Screate_simple(rank, part, NULL);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, part, NULL);
        /* all of it would be all that a part has by then: the run may have gone on */
        H5Sselect_hyperslab(source, H5S_SELECT_SET, origin, NULL, part, NULL);
        failed |= H5Pset_virtual(properties, space, parts + i * length, name_of(layout, field),
                                 source) < 0;
        H5Sclose(source);
    }
    hid_t set = new_set(file, name_of(layout, field), space, properties);
    failed |= set < 0 || H5Dclose(set) < 0;
    H5Pclose(properties);
    H5Sclose(space);
    return failed;
}

static int write_axis(hid_t file, const char *name, int64_t n, const double *values)
{
    hsize_t length = (hsize_t)n;
    hid_t space = H5Screate_simple(1, &length, NULL);
    hid_t properties = plain_properties();
    hid_t set = new_set(file, name, space, properties);
    int failed = H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0;
    failed |= H5Dclose(set) < 0;
    H5Pclose(properties);
    H5Sclose(space);
    return failed;
}

int stickslip_join_fields(const char *path, const field_layout *layout, const char *parts,
                          int64_t length, int64_t per_part, const double *axes)
{
    int failed = 0;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    hid_t file = new_file(path);
    if (file < 0)
        return 1;
    for (int k = 0; k <= layout->fields; k++)
        failed |= join_field(file, k, layout, parts, length, per_part);
    failed |= write_axis(file, layout->axes[0], layout->rows, axes);
    if (layout->columns > 1)
        failed |= write_axis(file, layout->axes[1], layout->columns, axes + layout->rows);
    return H5Fclose(file) < 0 || failed;
}
