/*
   Prescribed displacements d(t) = r(t) d of sets, in some directions. The directions have no inertia of their own in
   the integrator (minv = 0); the step from t_n gives them
      v_{n+1/2} = (d(t_n + dt) - d(t_n)) / dt
   and the drive exerts what the other forces f_n leave over, R_n = m (v_{n+1/2} - v_{n-1/2}) / dt - f_n, m the lumped
   mass, with the power R_n . (v_{n-1/2} + v_{n+1/2}) / 2: then the kinetic energy of the prescribed nodes is accounted
   for exactly.

   Along a component j of a node's basis q_j the directions D that are prescribed have the share s = sum_{d in D}
   q_jd^2. It must be 0 or 1: a body with radial and circumferential components cannot be prescribed in one direction
   across its axis alone.
*/
#include "externalimpl.h"
#include <petscbt.h>
#include <squeal/options.h>

#define SHARE_TOLERANCE 1e-8 /* of s, from 0 and 1 */

/* The flagged directions as a word such as "xz" */
static void MotionDirections(const PetscBool direction[3], char word[4])
{
  for (int d = 0; d < 3; d++)
    if (direction[d]) *word++ = "xyz"[d];
  *word = '\0';
}

/* Directions from a word, and by default those in which something moves */
static PetscErrorCode MotionSetDirections(MPI_Comm comm, Drive *motion, const char word[], PetscBool set)
{
  const PetscReal *x = motion->displacement;

  PetscFunctionBeginUser;
  PetscCheck(!set || (word[0] && strspn(word, "xyz") == strlen(word)), comm, PETSC_ERR_USER_INPUT,
             "-%s_directions '%s' must be some of the letters x, y, z", motion->name, word);
  PetscCheck(set || x[0] != 0 || x[1] != 0 || x[2] != 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_displacement is zero: give it (m), or -%s_directions to hold", motion->name, motion->name);
  for (int d = 0; d < 3; d++) {
    motion->direction[d] = (set ? !!strchr(word, "xyz"[d]) : x[d] != 0) ? PETSC_TRUE : PETSC_FALSE;
    PetscCheck(motion->direction[d] || x[d] == 0, comm, PETSC_ERR_USER_INPUT,
               "-%s_displacement has %.6g m along %c, which -%s_directions %s leaves out", motion->name, (double)x[d],
               "xyz"[d], motion -> name, word);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode MotionCheck(MPI_Comm comm, const Drive *motion)
{
  const PetscReal *x = motion->displacement;

  PetscFunctionBeginUser;
  PetscCall(OptionsCheckFinite(comm, motion->name, "displacement", "m", x));
  PetscCheck((x[0] == 0 && x[1] == 0 && x[2] == 0) || motion->ramp.length > 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_ramp %.6g must be given and positive (s): a displacement cannot jump", motion->name,
             motion->ramp.length);
  PetscFunctionReturn(0);
}

static PetscErrorCode MotionRead(OptionsItems PetscOptionsObject, void *owner, void *record)
{
  const MPI_Comm comm     = PetscOptionsObject->comm;
  Drive         *motion   = record;
  char           word[16] = "";
  PetscBool      given;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(OptionsGetSet(PetscOptionsObject, &motion->set));
  PetscCall(OptionsGetReals(PetscOptionsObject, "-displacement", "in x,y,z, m", 3, motion->displacement, NULL));
  PetscCall(PetscOptionsString("-directions",
                               "that are prescribed: some of x, y, z; by default those of the displacement",
                               "dynamics.h", word, word, sizeof(word), &given));
  PetscCall(RampSetFromOptions(PetscOptionsObject, &motion->ramp));
  PetscCall(MotionCheck(comm, motion));
  PetscCall(MotionSetDirections(comm, motion, word, given));
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsSetFromOptions(External external)
{
  static const OptionsList list = {"-motions", "prescribed displacements, each the prefix of its -set", "Motion",
                                   sizeof(Drive), MotionRead};

  PetscFunctionBeginUser;
  PetscCall(OptionsReadList(external->comm, &list, external, &external->n_motions, &external->motions));
  PetscFunctionReturn(0);
}

/* Share of the prescribed directions in component j of a vertex */
static PetscReal MotionShare(const Drive *motion, const Layout *layout, PetscInt vertex, int j)
{
  const PetscReal *q     = &layout->basis[9 * vertex + 3 * j];
  PetscReal        share = 0;

  for (int d = 0; d < 3; d++) share += motion->direction[d] ? q[d] * q[d] : 0;
  return share;
}

/* Appends the free prescribed components of a vertex and holds them; trouble[0] counts components that the directions
   split, trouble[1] those that another motion prescribes */
static PetscErrorCode MotionAddVertex(External external, Bodies bodies, PetscInt vertex, PetscBT taken, Drive *motion,
                                      PetscInt trouble[2])
{
  const Layout    *layout = external->layout;
  const PetscReal *x      = motion->displacement;

  PetscFunctionBeginUser;
  for (int j = 0; j < 3; j++) {
    const PetscInt   index = layout->at[vertex] + j * layout->step[vertex];
    const PetscReal *q     = &layout->basis[9 * vertex + 3 * j];
    const PetscReal  share = MotionShare(motion, layout, vertex, j);

    if (share < SHARE_TOLERANCE) continue;
    trouble[0] += share < 1 - SHARE_TOLERANCE;
    trouble[1] += PetscBTLookup(taken, index) ? 1 : 0;
    if (external->layout->minv[index] == 0) continue;
    motion->index[motion->n]  = index;
    motion->full[motion->n++] = q[0] * x[0] + q[1] * x[1] + q[2] * x[2];
    PetscCall(BodiesHold(bodies, vertex, j));
    PetscCall(PetscBTSet(taken, index));
  }
  PetscFunctionReturn(0);
}

/* Prescribed numbers of the set's vertices, those of owned vertices first */
static PetscErrorCode MotionFindNumbers(External external, Bodies bodies, PetscBT taken, Drive *motion,
                                        PetscInt trouble[2])
{
  PetscInt n, n_owned, *vertex;

  PetscFunctionBeginUser;
  PetscCall(ExternalFindVertices(external, motion->set, &n, &n_owned, &vertex));
  PetscCall(PetscMalloc4(3 * n, &motion->index, 3 * n, &motion->full, 3 * n, &motion->before, 3 * n, &motion->after));
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(MotionAddVertex(external, bodies, vertex[i], taken, motion, trouble));
    if (i < n_owned) motion->n_owned = motion->n;
  }
  PetscCall(PetscFree(vertex));
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsSetUp(External external, Bodies bodies)
{
  PetscBT taken;

  PetscFunctionBeginUser;
  PetscCall(PetscBTCreate(external->layout->n, &taken));
  for (PetscInt i = 0; i < external->n_motions; i++) {
    Drive   *motion   = &external->motions[i];
    PetscInt count[3] = {0, 0, 0};
    char     word[4];

    PetscCall(MotionFindNumbers(external, bodies, taken, motion, &count[1]));
    count[0] = motion->n;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 3, MPIU_INT, MPI_SUM, external->comm));
    MotionDirections(motion->direction, word);
    PetscCheck(
      !count[1], external->comm, PETSC_ERR_USER_INPUT,
      "-%s_directions %s splits the radial and circumferential components of a swept body on %s: prescribe both "
      "directions across its axis, or neither",
      motion->name, word, motion->set);
    PetscCheck(!count[2], external->comm, PETSC_ERR_USER_INPUT,
               "-%s_set %s has nodes that another of the -motions prescribes in the same direction", motion->name,
               motion->set);
    PetscCheck(count[0], external->comm, PETSC_ERR_USER_INPUT,
               "-%s_set %s is held by supports in all of the directions %s: the motion does nothing", motion->name,
               motion->set, word);
  }
  PetscCall(PetscBTDestroy(&taken));
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsAdvance(External external, const ExternalStep *step)
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < external->n_motions; m++) {
    Drive          *motion = &external->motions[m];
    const PetscReal begin  = RampValue(&motion->ramp, step->time);
    const PetscReal rate   = (RampValue(&motion->ramp, step->time + step->dt) - begin) / step->dt;

    for (PetscInt i = 0; i < motion->n; i++) {
      motion->before[i] = step->v[motion->index[i]];
      motion->after[i] = step->v[motion->index[i]] = rate * motion->full[i];
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsFinish(External external, PetscReal dt, const PetscReal f[])
{
  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < external->n_motions; m++) {
    const Drive *motion = &external->motions[m];

    for (PetscInt i = 0; i < motion->n_owned; i++) {
      const PetscReal before = motion->before[i], after = motion->after[i];
      const PetscReal drive = external->layout->total[motion->index[i]] * (after - before) / dt - f[motion->index[i]];

      *external->drives += drive * (before + after);
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsView(External external, PetscViewer viewer)
{
  char word[4], words[160];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_motions; i++) {
    const Drive     *motion = &external->motions[i];
    const PetscReal *x      = motion->displacement;

    MotionDirections(motion->direction, word);
    PetscCall(RampDescribe(&motion->ramp, sizeof(words), words));
    if (x[0] != 0 || x[1] != 0 || x[2] != 0)
      PetscCall(PetscViewerASCIIPrintf(viewer, "  motion %s: %s moved by %.6g, %.6g, %.6g m (%s prescribed), %s\n",
                                       motion->name, motion->set, (double)x[0], (double)x[1], (double)x[2], word,
                                       words));
    else
      PetscCall(PetscViewerASCIIPrintf(viewer, "  motion %s: %s held in %s\n", motion->name, motion->set, word));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsDestroy(External external)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < external->n_motions; i++) {
    Drive *motion = &external->motions[i];

    PetscCall(PetscFree(motion->name));
    PetscCall(PetscFree(motion->set));
    PetscCall(PetscFree4(motion->index, motion->full, motion->before, motion->after));
  }
  PetscCall(PetscFree(external->motions));
  PetscFunctionReturn(0);
}
