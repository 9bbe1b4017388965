/*
   How much each mode gives: |r_k| / |i omega - lambda_k| with the residue r_k = (l^T x)(y^T f) / (y^T Q'(lambda) x),
   whose denominator is 2 |lambda| |x|_M |y|_M / condition. A rigid mode gives (l^T x)(y^T f) / (y^T M x) / omega^2.
*/
#include "frfimpl.h"

#define POLE_ROUNDING 1e-14 /* relative distance of a frequency and a mode that rounding cannot tell from none */

/* Distance of i omega from the eigenvalue, rad/s */
static PetscReal ModeDistance(const Mode *mode, PetscReal omega)
{
  return hypot(mode->sigma, mode->omega - omega);
}

/* Raises an error for a frequency on an undamped mode: nearer to lambda, rad/s, than its error, or than rounding of
   omega. */
PetscErrorCode FrfCheckPoles(Frf frf)
{
  const Mode *mode;
  PetscInt    n;

  PetscFunctionBeginUser;
  PetscCall(ModesGet(frf->modes, &n, &mode));
  for (PetscInt i = 0; i < frf->n; i++)
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal omega = 2 * PETSC_PI * frf->freq[i];
      const PetscReal close = PetscMax(mode[k].error, POLE_ROUNDING * omega);

      PetscCheck(mode[k].rigid || ModeDistance(&mode[k], omega) > close, frf->comm, PETSC_ERR_USER_INPUT,
                 "-frf_frequencies: %.15g Hz is a pole, mode %" PetscInt_FMT
                 " without damping, where the response is infinite; move the frequency, or give damping",
                 (double)frf->freq[i], k + 1);
    }
  PetscFunctionReturn(0);
}

/* v^T (xr + i xi), without conjugation; xi NULL for a real vector. */
PetscErrorCode FrfDot(Vec v, Vec xr, Vec xi, PetscComplex *dot)
{
  PetscReal re, im = 0;

  PetscFunctionBeginUser;
  PetscCall(VecDot(v, xr, &re));
  if (xi) PetscCall(VecDot(v, xi, &im));
  *dot = CMPLX(re, im);
  PetscFunctionReturn(0);
}

/* residue [modes] = sqrt(sum_p |l_p^T x|^2) |y^T f| condition / (2 |lambda|), m/(N s), with vectors of unit length
   in M; 1/kg of a rigid mode. Moduli of all outputs together, as a peak is one of their root of the sum of squares. */
PetscErrorCode FrfResiduesCreate(Frf frf, FrfResidues *r)
{
  const Mode *mode;

  PetscFunctionBeginUser;
  PetscCall(ModesGet(frf->modes, &r->n, &mode));
  PetscCall(PetscCalloc1(r->n, &r->residue));
  for (PetscInt k = 0; k < r->n; k++) {
    const PetscReal size    = hypot(mode[k].sigma, mode[k].omega);
    PetscReal       outputs = 0;
    PetscComplex    input, output;
    Vec             xr, xi, yr, yi;

    PetscCall(ModesGetVectors(frf->modes, k, &xr, &xi, &yr, &yi));
    PetscCall(FrfDot(frf->f, yr, yi, &input));
    for (PetscInt p = 0; p < frf->n_outputs; p++) {
      PetscCall(FrfDot(frf->l[p], xr, xi, &output));
      outputs += PetscSqr(cabs(output));
    }
    r->residue[k] = PetscSqrtReal(outputs) * cabs(input) * mode[k].condition / (mode[k].rigid ? 1 : 2 * size);
  }
  PetscFunctionReturn(0);
}

/* The mode of the largest |r| / |i omega - lambda|, or -1 without modes; rigid ones by r / omega^2. */
PetscErrorCode FrfResiduesLargest(Frf frf, const FrfResidues *r, PetscReal omega, PetscInt *largest)
{
  const Mode *mode;
  PetscInt    n;
  PetscReal   most = 0;

  PetscFunctionBeginUser;
  PetscCall(ModesGet(frf->modes, &n, &mode));
  *largest = -1;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal here = r->residue[k] / (mode[k].rigid ? omega * omega : ModeDistance(&mode[k], omega));

    if (here > most) *largest = k;
    most = PetscMax(most, here);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FrfResiduesDestroy(FrfResidues *r)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(r->residue));
  PetscFunctionReturn(0);
}
