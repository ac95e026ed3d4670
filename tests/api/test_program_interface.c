/* The program's C interface where arguments are NULL or sizes make no sense: codes and NULL, never a crash, and no result
 * that is not one. */
#include <string.h>

#include "check.h"
#include "stickslip_program.h"

static const char input[] = "&friction law='coulomb', alpha_n=1000, alpha_t=1000, mu=0.4 /\n"
                            "&slider mass=1, stiffness=1, normal_traction=1 /\n"
                            "&drive velocity=1 /\n&time t_end=1, dt=1e-2 /\n";
static const char csv[] = "time,b\n0,1\n1,2\n";

/* No input: the code, and a result that may be freed. */
#define NOTHING(call)                           \
    do {                                        \
        result = (stickslip_result *)&failures; \
        CHECK((call) == STICKSLIP_NO_INPUT);    \
        CHECK(result == NULL);                  \
    } while (0)

static void what_is_missing_leaves_no_result(void)
{
    const char *names[2] = {"time", "b"}, *without[2] = {"time", NULL};
    stickslip_result *result;

    NOTHING(stickslip_run(NULL, input, NULL, NULL, &result));
    NOTHING(stickslip_run("x", NULL, NULL, NULL, &result));
    NOTHING(stickslip_stability(NULL, input, &result));
    NOTHING(stickslip_stability("x", NULL, &result));
    NOTHING(stickslip_groups(NULL, input, 3, &result));
    NOTHING(stickslip_groups("x", NULL, 0, &result));
    NOTHING(stickslip_groups("x", input, -1, &result));
    NOTHING(stickslip_columns(NULL, sizeof csv - 1, 2, names, &result));
    NOTHING(stickslip_columns(csv, -1, 2, names, &result));
    NOTHING(stickslip_columns(csv, sizeof csv - 1, 0, names, &result));
    NOTHING(stickslip_columns(csv, sizeof csv - 1, 2, NULL, &result));
    NOTHING(stickslip_columns(csv, sizeof csv - 1, 2147483647, NULL, &result));
    NOTHING(stickslip_columns(csv, sizeof csv - 1, 2, without, &result));
    CHECK(stickslip_run("x", input, NULL, NULL, NULL) == STICKSLIP_NO_INPUT);
    CHECK(stickslip_stability("x", input, NULL) == STICKSLIP_NO_INPUT);
    CHECK(stickslip_groups("x", input, 3, NULL) == STICKSLIP_NO_INPUT);
    CHECK(stickslip_columns(csv, sizeof csv - 1, 2, names, NULL) == STICKSLIP_NO_INPUT);
    stickslip_free(NULL);
}

static void tables_are_told_as_far_as_is_asked(void)
{
    stickslip_result *result;
    const char *names;
    int64_t rows;
    int columns;

    CHECK(stickslip_run("x", input, NULL, NULL, &result) == STICKSLIP_DONE);
    CHECK(stickslip_table(result, "series", &rows, &columns, &names) != NULL && rows == 101 && columns == 11);
    CHECK(strncmp(names, "time,drive,", 11) == 0);
    CHECK(stickslip_table(result, "series", NULL, NULL, NULL) != NULL);
    CHECK(stickslip_table(result, "nothing", &rows, &columns, &names) == NULL && rows == 0 && names == NULL);
    CHECK(stickslip_table(result, NULL, NULL, NULL, NULL) == NULL && stickslip_table(NULL, "series", NULL, NULL, NULL) == NULL);
    CHECK(stickslip_report(result, NULL) == NULL && stickslip_report(NULL, "faults") == NULL);
    CHECK(strcmp(stickslip_report(result, "faults"), "") == 0);
    stickslip_free(result);
}

int main(void)
{
    what_is_missing_leaves_no_result();
    tables_are_told_as_far_as_is_asked();
    return failures != 0;
}
