/*
   Kinds of shapes of a solid that is long, as a beam, a plate or a pad is. q_1, q_2, q_3 are its principal axes, the
   longest first, sections are those across q_1, and P_i are Legendre polynomials, i = 0..12, of q_1 over its half
   length. Fields of displacement of each kind:

      rigid             translations and small rotations
      bending           u_3 = P_i(q_1), u_1 = q_3 P_i(q_1)            rigid sections move along the thin side, and turn
      in-plane bending  u_2 = P_i(q_1), u_1 = q_2 P_i(q_1)            the same along the broad side
      torsion           (u_2, u_3) = (-q_3, q_2) P_i(q_1)             they turn about the long axis
      longitudinal      u_1 = P_i(q_1)                                they move along it
      cross bending     u_3 = P_i(q_2), u_2 = q_3 P_i(q_2), i >= 2    a plate's bending about its long axis

   The share of a kind is what its fields explain, by least squares with nodal masses, of the kinetic energy of the
   shape. A shape is rigid where that is 99.5 % (the first bending of a clamped beam is so by 99.04 %), else of the kind
   with the largest share if it is more than one half; without such a kind, as (2,2) of a plate, it is of none.

   With s_1 >= s_2 >= s_3 the second moments per mass, a solid is long for s_3 <= s_1 / 9 (its thickness a third of its
   length) and s_2 < 0.95 s_1: a square plate has no long axis, and shapes of equal frequencies that any basis serves.
   For s_3 > 0.95 s_2 the section has no thin side, and both bendings are one kind.
*/
#include "solid.h"
#include "base/algebra/dense.h"
#include "base/algebra/vec3.h"

#define SOLID_ENTIRE 0.995 /* share of rigid fields in a rigid shape */
#define SOLID_MOST   0.5   /* of the energy, what another kind must explain */
#define SOLID_EQUAL  0.95  /* of a second moment: another one that is as large */
#define SOLID_THIN   9     /* largest second moment of a long solid, beside the least */
#define SOLID_RANK   1e-9  /* of the largest eigenvalue: fields that the nodes tell apart */
#define SOLID_TIE    1e-6  /* relative: of shares that differ less the first one counts */

const char *SolidKindName(SolidKind kind)
{
  static const char *const name[] = {[SOLID_NONE] = "elastic",        [SOLID_RIGID] = "rigid",
                                     [SOLID_BENDING] = "bending",     [SOLID_IN_PLANE] = "in-plane bending",
                                     [SOLID_TORSION] = "torsion",     [SOLID_LENGTHWISE] = "longitudinal",
                                     [SOLID_ACROSS] = "cross bending"};

  return name[kind];
}

/* Place of a node along the principal axes, m */
static void SolidPlace(const SolidFrame *s, PetscInt v, PetscReal q[3])
{
  PetscReal d[3];

  for (int k = 0; k < 3; k++) d[k] = s->x[3 * v + k] - s->centre[k];
  for (int k = 0; k < 3; k++) q[k] = Vec3Dot(d, s->axis[k]);
}

/* Centre, axes, and what follows from the second moments */
static PetscErrorCode SolidFindAxes(SolidFrame *s)
{
  PetscReal sums[10] = {0}, a[9], moment[3];

  PetscFunctionBeginUser;
  for (int pass = 0; pass < 2; pass++) { /* the centre, then the moments about it, which keep their digits */
    PetscCall(PetscArrayzero(sums, 10));
    for (PetscInt v = 0; v < s->n_nodes; v++) {
      PetscReal d[3];

      for (int k = 0; k < 3; k++) d[k] = s->x[3 * v + k] - s->centre[k];
      for (int k = 0; k < 3; k++) sums[k] += s->mass[v] * d[k] * (pass == 0);
      for (int k = 0; k < 9 && pass; k++) sums[k] += s->mass[v] * d[k / 3] * d[k % 3];
      sums[9] += s->mass[v];
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 10, MPIU_REAL, MPI_SUM, s->comm));
    for (int k = 0; k < 3 && !pass; k++) s->centre[k] = sums[k] / sums[9];
  }
  for (int k = 0; k < 9; k++) a[k] = sums[k] / sums[9];
  PetscCall(DenseSymmetricEigen(3, a, NULL, moment, NULL));
  for (int k = 0; k < 9; k++) s->axis[2 - k / 3][k % 3] = a[k];
  s->is_long = SOLID_THIN * moment[0] <= moment[2] && moment[1] < SOLID_EQUAL * moment[2] ? PETSC_TRUE : PETSC_FALSE;
  s->is_even = moment[0] > SOLID_EQUAL * moment[1] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Half lengths along the axes; 1 where there is none, which no field then depends on */
static PetscErrorCode SolidFindLengths(SolidFrame *s)
{
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->n_nodes; v++) {
    PetscReal q[3];

    SolidPlace(s, v, q);
    for (int k = 0; k < 3 && s->mass[v] > 0; k++) s->half[k] = PetscMax(s->half[k], PetscAbsReal(q[k]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->half, 3, MPIU_REAL, MPI_MAX, s->comm));
  for (int k = 0; k < 3; k++)
    if (s->half[k] <= 1e-9 * s->half[0]) s->half[k] = 1;
  PetscFunctionReturn(0);
}

static void Legendre(PetscReal s, PetscReal p[SOLID_DEGREE + 1])
{
  p[0] = 1;
  p[1] = s;
  for (int i = 2; i <= SOLID_DEGREE; i++) p[i] = ((2 * i - 1) * s * p[i - 1] - (i - 1) * p[i - 2]) / i;
}

/* Adds to row[n][3] the fields of sections across axis `along` that move along axis `to` and turn, from degree first */
static int FieldsOfSections(const PetscReal q[3], const PetscReal half[3], int along, int to, int first,
                            PetscReal row[][3])
{
  PetscReal p[SOLID_DEGREE + 1];
  int       n = 0;

  Legendre(q[along] / half[along], p);
  for (int i = first; i <= SOLID_DEGREE; i++) {
    row[n++][to]    = p[i];
    row[n++][along] = q[to] / half[to] * p[i];
  }
  return n;
}

static int FieldsRigid(const PetscReal q[3], const PetscReal half[3], PetscReal row[][3])
{
  for (int k = 0; k < 3; k++) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;

    row[k][k]     = 1;
    row[3 + k][a] = -q[b] / half[0];
    row[3 + k][b] = q[a] / half[0];
  }
  return 6;
}

/* Fields of a kind at a node, row [SOLID_FIELDS][3] along the principal axes; how many there are: of those that there
   may be the others stay as they are */
static int SolidFields(const SolidFrame *s, SolidKind kind, const PetscReal q[3], PetscReal row[][3])
{
  static const int fields[N_SOLID_KINDS] = {[SOLID_RIGID]      = 6,
                                            [SOLID_BENDING]    = SOLID_FIELDS,
                                            [SOLID_IN_PLANE]   = SOLID_FIELDS / 2,
                                            [SOLID_TORSION]    = SOLID_DEGREE + 1,
                                            [SOLID_LENGTHWISE] = SOLID_DEGREE + 1,
                                            [SOLID_ACROSS]     = SOLID_FIELDS / 2};

  PetscReal p[SOLID_DEGREE + 1];
  int       n = 0;

  for (int k = 0; k < fields[kind]; k++) row[k][0] = row[k][1] = row[k][2] = 0;
  if (kind == SOLID_RIGID) return FieldsRigid(q, s->half, row);
  if (!s->is_long) return 0;
  Legendre(q[0] / s->half[0], p);
  if (kind == SOLID_BENDING) n = FieldsOfSections(q, s->half, 0, 2, 0, row);
  if (kind == SOLID_BENDING && s->is_even) n += FieldsOfSections(q, s->half, 0, 1, 0, &row[n]);
  if (kind == SOLID_IN_PLANE && !s->is_even) n = FieldsOfSections(q, s->half, 0, 1, 0, row);
  if (kind == SOLID_ACROSS && !s->is_even) n = FieldsOfSections(q, s->half, 1, 2, 2, row);
  for (int i = 0; i <= SOLID_DEGREE && kind == SOLID_LENGTHWISE; i++) row[n++][0] = p[i];
  for (int i = 0; i <= SOLID_DEGREE && kind == SOLID_TORSION; i++, n++) {
    row[n][1] = -q[2] / s->half[1] * p[i];
    row[n][2] = q[1] / s->half[1] * p[i];
  }
  return n;
}

/* Normal equations of a kind, as eigenvalues and eigenvectors: a coarse mesh does not tell all fields apart */
static PetscErrorCode SolidPrepare(const SolidFrame *s, SolidKind kind, SolidFamily *family)
{
  PetscReal row[SOLID_FIELDS][3], q[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  family->n = SolidFields(s, kind, q, row);
  if (!family->n) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(family->n * family->n, &family->gram));
  PetscCall(PetscMalloc1(family->n, &family->value));
  for (PetscInt v = 0; v < s->n_nodes; v++) {
    if (s->mass[v] <= 0) continue;
    SolidPlace(s, v, q);
    SolidFields(s, kind, q, row);
    for (int j = 0; j < family->n; j++)
      for (int i = 0; i <= j; i++) family->gram[j * family->n + i] += s->mass[v] * Vec3Dot(row[i], row[j]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, family->gram, family->n * family->n, MPIU_REAL, MPI_SUM, s->comm));
  PetscCall(DenseSymmetricEigen(family->n, family->gram, NULL, family->value, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode SolidCreate(MPI_Comm comm, PetscInt n_nodes, const PetscReal x[], const PetscReal mass[],
                           SolidFrame *solid)
{
  PetscFunctionBeginUser;
  *solid = (SolidFrame){.comm = comm, .n_nodes = n_nodes, .x = x, .mass = mass};
  PetscCall(SolidFindAxes(solid));
  PetscCall(SolidFindLengths(solid));
  for (int kind = SOLID_RIGID; kind < N_SOLID_KINDS; kind++)
    PetscCall(SolidPrepare(solid, (SolidKind)kind, &solid->family[kind]));
  PetscFunctionReturn(0);
}

/* Energy of the projection with right-hand sides b: sum_k (v_k' b)^2 / value_k */
static PetscReal FamilyEnergy(const SolidFamily *family, const PetscReal b[])
{
  PetscReal sum = 0;

  for (int k = 0; k < family->n; k++) {
    PetscReal dot = 0;

    if (!(family->value[k] > SOLID_RANK * family->value[family->n - 1])) continue;
    for (int j = 0; j < family->n; j++) dot += family->gram[k * family->n + j] * b[j];
    sum += dot * dot / family->value[k];
  }
  return sum;
}

PetscErrorCode SolidAddEnergies(const SolidFrame *s, const PetscReal u[], PetscReal energy[])
{
  PetscReal b[1 + (N_SOLID_KINDS - 1) * SOLID_FIELDS] = {0}, row[SOLID_FIELDS][3], q[3], w[3];

  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->n_nodes; v++) {
    if (s->mass[v] <= 0) continue;
    SolidPlace(s, v, q);
    for (int k = 0; k < 3; k++) w[k] = Vec3Dot(&u[3 * v], s->axis[k]);
    b[0] += s->mass[v] * Vec3Dot(w, w);
    for (int kind = SOLID_RIGID; kind < N_SOLID_KINDS; kind++) {
      const int n = SolidFields(s, (SolidKind)kind, q, row);

      for (int j = 0; j < n; j++) b[1 + (kind - 1) * SOLID_FIELDS + j] += s->mass[v] * Vec3Dot(row[j], w);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, b, PETSC_STATIC_ARRAY_LENGTH(b), MPIU_REAL, MPI_SUM, s->comm));
  energy[SOLID_NONE] += b[0];
  for (int kind = SOLID_RIGID; kind < N_SOLID_KINDS; kind++)
    energy[kind] += FamilyEnergy(&s->family[kind], &b[1 + (kind - 1) * SOLID_FIELDS]);
  PetscFunctionReturn(0);
}

SolidKind SolidJudge(const PetscReal energy[])
{
  PetscReal most = SOLID_MOST * energy[SOLID_NONE];
  SolidKind kind = SOLID_NONE;

  if (energy[SOLID_RIGID] > SOLID_ENTIRE * energy[SOLID_NONE]) return SOLID_RIGID;
  for (int k = SOLID_BENDING; k < N_SOLID_KINDS; k++) {
    if (!(energy[k] > (1 + SOLID_TIE) * most)) continue;
    most = energy[k];
    kind = (SolidKind)k;
  }
  return kind;
}

PetscErrorCode SolidDestroy(SolidFrame *solid)
{
  PetscFunctionBeginUser;
  for (int kind = SOLID_RIGID; kind < N_SOLID_KINDS; kind++) {
    PetscCall(PetscFree(solid->family[kind].gram));
    PetscCall(PetscFree(solid->family[kind].value));
  }
  PetscFunctionReturn(0);
}
