/*
   A library for LD_PRELOAD of tests: a rank that waits for a message sleeps. Open MPI looks for messages without end, and
   calls sched_yield(2) in between; with two tests of two ranks on two cores a third of the processors' time went there.
   Here a rank gives way AT_ONCE times, as always, and from then on sleeps until it has worked again: for PERIOD, which
   is how much later it may see a message. No program of users loads this: where each rank has a core, to look is faster.
*/
#define _GNU_SOURCE
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#define AT_ONCE 20
#define PERIOD  20000 /* ns */
#define WORKED  10000 /* ns between two calls that are not of one wait */

static long Now(void)
{
  struct timespec now;

  (void)clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1000000000L + now.tv_nsec;
}

int sched_yield(void)
{
  static __thread long       last;
  static __thread int        n;
  static const struct timespec pause = {0, PERIOD};

  if (Now() - last > WORKED) n = 0;
  if (++n < AT_ONCE) (void)syscall(SYS_sched_yield);
  else {
    if (n == AT_ONCE) (void)prctl(PR_SET_TIMERSLACK, 1L); /* ns by which the system may lengthen a sleep */
    (void)nanosleep(&pause, NULL);
  }
  last = Now();
  return 0;
}
