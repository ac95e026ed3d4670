/* A line and the end of the program. In C: Fortran's own output and stop need the run-time library of
 * one compiler, and hosts have been built by another. */
#include <stdio.h>
#include <stdlib.h>

void stickslip_end_host(const char *text, int stream, int exit_status);

void stickslip_end_host(const char *text, int stream, int exit_status)
{
    FILE *file = stream == 2 ? stderr : stdout;

    fflush(stdout);
    fprintf(file, "%s\n", text);
    fflush(file);
    exit(exit_status);
}
