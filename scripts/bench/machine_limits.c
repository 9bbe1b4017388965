/*
   Limits of one core of this machine, for the benchmarks: bandwidth of the triad a = b + s c in GB/s, counted as 24
   bytes an entry (McCalpin, IEEE TCCA Newsletter, 1995), and rate of fused multiply-adds in Gflop/s, 2 flops each, on
   numbers in registers. Best of several tries each. To be compiled where it runs:
   cc -O3 -march=native machine_limits.c -o machine_limits -lm

   usage: machine_limits [entries of each array]; prints `triad_gb_s fma_gflop_s`
*/
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum {
  N_TRIES = 5,
  N_LANES = 48, /* independent sums: as many as hide the latency of two units with the widest registers */
  N_SUMS  = 2000000
};

/* s */
static double Now(void)
{
  struct timespec t;

  (void)clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Bandwidth of one pass over arrays of n entries; kept out of line, so that it is not merged with the check */
__attribute__((noinline)) static double Triad(size_t n, double *restrict a, const double *restrict b,
                                              const double *restrict c, double s)
{
  const double begun = Now();

  for (size_t i = 0; i < n; i++) a[i] = b[i] + s * c[i];
  return 24e-9 * (double)n / (Now() - begun);
}

/* Rate of x = x m + d on N_LANES numbers; the sum of all is given back, so that the work must be done */
__attribute__((noinline)) static double MultiplyAdd(double m, double d, double *sum)
{
  double       x[N_LANES];
  const double begun = Now();

  for (int k = 0; k < N_LANES; k++) x[k] = k;
  for (int i = 0; i < N_SUMS; i++)
    for (int k = 0; k < N_LANES; k++) x[k] = fma(x[k], m, d);
  for (int k = 0; k < N_LANES; k++) *sum += x[k];
  return 2e-9 * (double)N_SUMS * N_LANES / (Now() - begun);
}

int main(int argc, char *argv[])
{
  const size_t n = argc > 1 ? strtoul(argv[1], NULL, 10) : 20000000;
  double      *a = malloc(n * sizeof(*a)), *b = malloc(n * sizeof(*b)), *c = malloc(n * sizeof(*c));
  double       triad = 0, rate = 0, sum = 0;

  if (n < 1 || !a || !b || !c) {
    (void)fprintf(stderr, "machine_limits: no memory for three arrays of %zu entries\n", n);
    return 1;
  }
  for (size_t i = 0; i < n; i++) a[i] = 0, b[i] = 1, c[i] = 2;
  for (int try = 0; try < N_TRIES; try++) {
    triad = fmax(triad, Triad(n, a, b, c, 3.0));
    rate  = fmax(rate, MultiplyAdd(1 - 1e-9, 1e-9, &sum));
  }
  if (a[n - 1] != 7 || !isfinite(sum)) return 1;
  (void)printf("%.2f %.2f\n", triad, rate);
  free(a);
  free(b);
  free(c);
  return 0;
}
