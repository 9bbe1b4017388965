/* Power and pressure of a harmonic motion: sums over the points of the surface */
#include "soundimpl.h"

PetscErrorCode SoundMeasurePower(Sound sound, const PetscReal vr[], const PetscReal vi[], PetscReal power[])
{
  const SoundSurface *s = &sound->surface;
  const Mesh         *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(sound->model, &mesh));
  PetscCall(PetscArrayzero(power, mesh->n_parts));
  for (PetscInt q = 0; q < s->n; q++) {
    const PetscReal re = SoundSurfaceNormal(s, q, vr), im = SoundSurfaceNormal(s, q, vi);

    power[s->part[q]] += sound->density * sound->speed / 2 * s->area[q] * (re * re + im * im);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, power, (PetscMPIInt)mesh->n_parts, MPIU_REAL, MPI_SUM, sound->comm));
  PetscFunctionReturn(0);
}

/* Adds i omega rho / (2 pi) v_n e^{-i k R} / R dA of one point */
static void SoundAddPoint(const Sound sound, PetscReal omega, PetscReal R, PetscReal area, const PetscReal v[2],
                          PetscReal p[2])
{
  const PetscReal size = omega * sound->density * area / (2 * PETSC_PI * R), phase = -omega * R / sound->speed;
  const PetscReal c = size * PetscCosReal(phase), s = size * PetscSinReal(phase);

  p[0] += -s * v[0] - c * v[1]; /* of i (c + i s) (v_0 + i v_1) */
  p[1] += c * v[0] - s * v[1];
}

PetscErrorCode SoundMeasurePressure(Sound sound, PetscReal omega, const PetscReal vr[], const PetscReal vi[],
                                    PetscReal pr[], PetscReal pi[])
{
  const SoundSurface *s = &sound->surface;
  PetscReal(*p)[2];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(sound->n, &p));
  for (PetscInt q = 0; q < s->n; q++) {
    const PetscReal v[2] = {SoundSurfaceNormal(s, q, vr), SoundSurfaceNormal(s, q, vi)};

    for (PetscInt i = 0; i < sound->n; i++) {
      PetscReal x[3], R;

      SoundPlace(sound, i, x);
      R = SoundSurfaceDistance(s, q, x);
      if (R > 0) SoundAddPoint(sound, omega, R, s->area[q], v, p[i]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, p, (PetscMPIInt)(2 * sound->n), MPIU_REAL, MPI_SUM, sound->comm));
  for (PetscInt i = 0; i < sound->n; i++) {
    pr[i] = p[i][0];
    pi[i] = p[i][1];
  }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}
