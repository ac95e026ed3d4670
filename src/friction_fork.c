/* Tells a process that was forked after the library was loaded. The threads of OpenMP stay with the
 * parent, and the child must not call them. Without OpenMP there is nothing to tell. */
int stickslip_in_forked_process(void);

#ifdef STICKSLIP_WATCH_FORK

#include <pthread.h>

static volatile int forked = 0;

static void note_fork(void)
{
    forked = 1;
}

__attribute__((constructor)) static void watch_fork(void)
{
    pthread_atfork(0, 0, note_fork);
}

int stickslip_in_forked_process(void)
{
    return forked;
}

#else

int stickslip_in_forked_process(void)
{
    return 0;
}

#endif
