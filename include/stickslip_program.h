/* stickslip: the program's spring-slider without files, C interface of libstickslip_program.
 *
 * A run is a function of its input alone; any number of them may go on at the same time, each in its thread. */
#ifndef STICKSLIP_PROGRAM_H
#define STICKSLIP_PROGRAM_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct stickslip_result stickslip_result;

/* Called now and then during a run, in its thread: `part` is how much of it is done, 0 to 1. A value other than 0 ends
 * the run. */
typedef int (*stickslip_watch)(double part, void *context);

/* Runs the slider on an input that is in memory.
 *   name      of the input, for messages; files that it names are looked for beside it
 *   text      namelists, as `stickslip run` reads them (docs/driver.md)
 *   watch     see above; or NULL
 *   context   handed to it
 *   result    what was found, to be freed by stickslip_free whatever the function's value; NULL after
 *             STICKSLIP_NO_INPUT
 * Returns a stickslip_outcome. Snapshots of a chain's blocks (`fields`) and checkpoints are files, and are not written. */
int stickslip_run(const char *name, const char *text, stickslip_watch watch, void *context, stickslip_result **result);

/* Tells whether steady sliding of the slider of such an input is stable (docs/stability.md): the tables "stability", a row for
 * each piece of the programme in which the drive moves (`stability`: 0 none, 1 stable, 2 neutral, 3 unstable), and
 * "eigenvalues"; the report "reasons", why there is no steady sliding, a line a row. Arguments and values as above;
 * STICKSLIP_FAILED where nothing slides steadily. */
int stickslip_stability(const char *name, const char *text, stickslip_result **result);

/* Takes namelists apart, as the program reads them: the report "groups" is a JSON object of groups, each an object of keys with
 * a number, text or truth value or a list of them; "text" is the content in UTF-8 without a byte-order mark. What keys there
 * may be, and with which values, stickslip_run alone knows.
 *   name      of the input, for messages
 *   content   of a file: UTF-8, UTF-16 or Latin-1, with any line ends
 *   bytes     size of the content, >= 0
 *   result    as above
 * Returns STICKSLIP_DONE, STICKSLIP_BAD_INPUT or STICKSLIP_NO_INPUT. */
int stickslip_groups(const char *name, const char *content, int64_t bytes, stickslip_result **result);

/* Takes columns of numbers from a table, as the program reads measured files (docs/driver.md): the table "columns" has them in
 * the order of the names, without names of its own.
 *   content, bytes   as above
 *   n                number of columns, >= 1
 *   names            theirs, as the file has them or without regard to case or to a unit behind them
 *   result           as above; the report "faults" tells what is wrong, a line each
 * Returns STICKSLIP_DONE, STICKSLIP_BAD_INPUT or STICKSLIP_NO_INPUT. */
int stickslip_columns(const char *content, int64_t bytes, int n, const char *const *names, stickslip_result **result);

enum stickslip_outcome {
    STICKSLIP_DONE = 0,       /* the run reached its end */
    STICKSLIP_FAILED = 1,     /* it ended before: stickslip_report(result, "failure"); the tables hold what came before */
    STICKSLIP_BAD_INPUT = 2,  /* nothing was run: stickslip_report(result, "faults") */
    STICKSLIP_NO_INPUT = -8   /* a pointer argument is NULL, or a size negative */
};

/* One of the tables of a run: "series", "events", "catalogue" (of a chain: the events of its blocks, docs/chains.md; without rows for
 * one block), "pieces" (of the programme), "summary" (one row); or of stickslip_stability.
 *   rows      receives the number of rows
 *   columns   receives the number of columns
 *   names     receives the names of the columns with commas between them; each of the three may be NULL
 * Returns its numbers, row after row, or NULL where there is no such table. They, and the names, live as long as the
 * result. */
const double *stickslip_table(const stickslip_result *result, const char *table, int64_t *rows, int *columns,
                              const char **names);

/* Text about a result: "faults" of the input, one a line; "failure", why a run ended early; "warnings", one a line. Empty where
 * there is none, NULL where there is no such report. Lives as long as the result. */
const char *stickslip_report(const stickslip_result *result, const char *report);

/* Gives back the memory of a result; NULL is no fault. */
void stickslip_free(stickslip_result *result);

#ifdef __cplusplus
}
#endif

#endif
