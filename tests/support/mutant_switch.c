/* Which mutant a test runs, from its environment: STICKSLIP_MUTANT. Without one (-1), notes go into a file, a byte a
 * mutant: 1 reached, 2 another value, 4 its value must not be asked for: the program was ended by that.
 * STICKSLIP_SECONDS limits the time of the processor. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

int stickslip_mutant;
static unsigned char *notes;
static __thread volatile int asked;   /* the last one */

static void ended(int signal_)
{
    (void)signal_;
    notes[asked] |= 4;
    _exit(99);
}

/* Takes the place of the C library's, with which Fortran's run-time library would take these signals. */
void (*signal(int number, void (*handler)(int)))(int)
{
    struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART}, before;
    if (notes && (number == SIGSEGV || number == SIGFPE || number == SIGBUS)) return SIG_DFL;
    return sigaction(number, &action, &before) ? SIG_ERR : before.sa_handler;
}

/* No exception is seen: of the variants of a statement a compiler evaluates more than the one that counts. */
void __ieee_exceptions_MOD_ieee_get_flag(const int *flag, int *raised)
{
    (void)flag;
    *raised = 0;
}

__attribute__((constructor)) static void start(void)
{
    const char *number = getenv("STICKSLIP_MUTANT"), *seconds = getenv("STICKSLIP_SECONDS");
    const char *file = getenv("STICKSLIP_NOTES"), *size = getenv("STICKSLIP_MUTANTS");
    if (seconds) {
        double limit = atof(seconds);
        struct itimerval timer = {{0, 0}, {(time_t)limit, (suseconds_t)(1e6 * (limit - (time_t)limit))}};
        setitimer(ITIMER_PROF, &timer, NULL);
    }
    if (file && size) {
        int opened = open(file, O_RDWR);
        if (opened < 0) abort();
        notes = mmap(NULL, atol(size) + 1, PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0);
        if (notes == MAP_FAILED) abort();
        struct sigaction action = {.sa_handler = ended};
        sigaction(SIGSEGV, &action, NULL);
        sigaction(SIGFPE, &action, NULL);
        sigaction(SIGBUS, &action, NULL);
    }
    if (number && (notes || number[0] != '-')) stickslip_mutant = atoi(number);
}

/* Without notes they may be called all the same: compilers evaluate both sides of .and. */
void mutant_reached(int first, int last)
{
    if (!notes) return;
    for (int number = first; number <= last; number++) notes[number] |= 1;
}

void mutant_differs(int number)
{
    if (notes) notes[number] |= 2;
}

bool mutant_may(int number)
{
    if (!notes) return false;
    asked = number;
    if (notes[number] & 4) mutant_differs(number);
    return !(notes[number] & 4);
}

bool mutant_seen(int first, int last)
{
    mutant_reached(first, last);
    return false;
}

bool mutant_noted(int number, bool differs)
{
    if (differs) mutant_differs(number);
    return false;
}
