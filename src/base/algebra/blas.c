/*
   The BLAS that the program runs on. OpenBLAS chooses its kernels as it is loaded, by a table of processors that were
   known when it was released. For a newer one it may take kernels of 2004 (Prescott), with which a factorisation takes
   two to three times as long. OPENBLAS_CORETYPE in the environment names others. Results differ by rounding, so that a
   run tells which they were.
*/
#include "blas.h"
#include <string.h>
#include <strings.h>

#if defined(__GNUC__)
#define WEAK __attribute__((weak))
#else
#define WEAK
#endif

/* Of OpenBLAS; null where the BLAS is another one */
extern WEAK char *openblas_get_config(void);
extern WEAK char *openblas_get_corename(void);

/* Its kernels for registers of 32 bytes and more */
static const char *const wide[] = {"Excavator", "Haswell", "Zen", "SkylakeX", "Cooperlake", "SapphireRapids"};

void BlasGetName(size_t length, char name[])
{
  const char *config = openblas_get_config ? openblas_get_config() : "";
  const char *number = strchr(config, ' ');

  if (!openblas_get_corename || !number)
    (void)snprintf(name, length, "BLAS other than OpenBLAS");
  else
    (void)snprintf(name, length, "%.*s (%s)", (int)(number + 1 - config + (int)strcspn(number + 1, " ")), config,
                   openblas_get_corename());
}

const char *BlasBetterKernels(void)
{
  if (!openblas_get_corename || getenv("OPENBLAS_CORETYPE")) return NULL;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(wide); i++)
    if (!strcasecmp(openblas_get_corename(), wide[i])) return NULL;
#if defined(__GNUC__) && defined(__x86_64__)
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return NULL;
}
