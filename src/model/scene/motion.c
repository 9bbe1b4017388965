/*
   Motions: displacements of named sets that are prescribed along some of the directions x, y, z. Where they are held,
   as they are outside time, u = d there (0 where they swing): these displacements are no unknowns, and K_fd d is a
   load on the free ones. A direction that a support fixes stays fixed.
*/
#include "model/modelimpl.h"
#include "quantity/ramp.h"
#include <petscbt.h>
#include <squeal/options.h>

/* The flagged directions as a word such as "xz" */
static void MotionWord(const PetscBool direction[3], char word[4])
{
  for (int d = 0; d < 3; d++)
    if (direction[d]) *word++ = "xyz"[d];
  *word = '\0';
}

/* Directions from a word, and by default those in which something moves */
PetscErrorCode MotionCheck(MPI_Comm comm, void *owner, void *record)
{
  PrescribedMotion *motion = record;
  const char *const word   = motion->word;
  const PetscBool   set    = motion->has_word;
  const PetscReal  *x      = motion->displacement;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(RampSwings(motion->name, &motion->swings));
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

PetscErrorCode ModelCheckMotion(Model model, const PrescribedMotion *motion, PetscInt n_held, PetscInt n_twice)
{
  PetscInt count[2] = {n_held, n_twice};
  char     word[4];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 2, MPIU_INT, MPI_SUM, model->comm));
  MotionWord(motion->direction, word);
  PetscCheck(!count[1], model->comm, PETSC_ERR_USER_INPUT,
             "-%s_set %s has nodes that another of the -motions prescribes in the same direction", motion->name,
             motion->set);
  PetscCheck(count[0], model->comm, PETSC_ERR_USER_INPUT,
             "-%s_set %s is held by supports in all of the directions %s: the motion does nothing", motion->name,
             motion->set, word);
  PetscFunctionReturn(0);
}

PetscErrorCode ModelDescribeMotion(const PrescribedMotion *motion, size_t size, char words[])
{
  const PetscReal *x = motion->displacement;
  char             word[4];

  PetscFunctionBeginUser;
  MotionWord(motion->direction, word);
  if (x[0] != 0 || x[1] != 0 || x[2] != 0)
    PetscCall(PetscSNPrintf(words, size, "motion %s: %s moved by %.6g, %.6g, %.6g m (%s prescribed)", motion->name,
                            motion->set, (double)x[0], (double)x[1], (double)x[2], word));
  else
    PetscCall(PetscSNPrintf(words, size, "motion %s: %s held in %s", motion->name, motion->set, word));
  PetscFunctionReturn(0);
}

/* Flags what one motion prescribes; taken are the directions of those before */
static PetscErrorCode MotionFlag(Model model, const PrescribedMotion *motion, PetscBT taken, PetscBool fixed[][3],
                                 PetscReal prescribed[])
{
  PetscInt n, n_held = 0, n_twice = 0, *vertex;

  PetscFunctionBeginUser;
  PetscCall(ModelGetSetNodes(model, motion->set, &n, &vertex));
  for (PetscInt i = 0; i < 3 * n; i++) {
    const PetscInt v = vertex[i / 3], d = i % 3, at = 3 * v + d;

    if (!motion->direction[d]) continue;
    n_twice += PetscBTLookup(taken, at) ? 1 : 0;
    if (fixed[v][d]) continue;
    PetscCall(PetscBTSet(taken, at));
    fixed[v][d]    = PETSC_TRUE;
    prescribed[at] = motion->displacement[d];
    n_held++;
  }
  PetscCall(PetscFree(vertex));
  PetscCall(ModelCheckMotion(model, motion, n_held, n_twice));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetMotion(Model model, PetscInt i, PetscReal nodal[])
{
  const Mesh             *mesh   = &model->mesh;
  const PrescribedMotion *motion = &model->scene.motions[i];
  PetscInt                n, *vertex;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(nodal, 3 * mesh->n_nodes));
  PetscCall(ModelGetSetNodes(model, motion->set, &n, &vertex));
  for (PetscInt k = 0; k < 3 * n; k++) {
    const PetscInt at = 3 * vertex[k / 3] + k % 3;

    if (motion->direction[k % 3]) nodal[at] = mesh->prescribed[at];
  }
  PetscCall(PetscFree(vertex));
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetMotions(Model model, const PetscReal share[], PetscReal nodal[])
{
  const Mesh *mesh = &model->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(nodal, mesh->prescribed, 3 * mesh->n_nodes));
  for (PetscInt i = 0; i < model->scene.n_motions; i++) {
    const PrescribedMotion *motion = &model->scene.motions[i];
    const PetscReal         part   = motion->swings ? 0 : share ? share[i] : 1;
    PetscInt                n, *vertex;

    if (part == 1) continue;
    PetscCall(ModelGetSetNodes(model, motion->set, &n, &vertex));
    for (PetscInt k = 0; k < 3 * n; k++)
      if (motion->direction[k % 3]) nodal[3 * vertex[k / 3] + k % 3] *= part;
    PetscCall(PetscFree(vertex));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelGetDisplaced(Model model, Vec u, PetscReal nodal[])
{
  const Mesh *mesh = &model->mesh;
  PetscReal  *held;

  PetscFunctionBeginUser;
  PetscCall(ModelGetNodal(model, u, nodal));
  if (!mesh->prescribed) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(3 * mesh->n_nodes, &held));
  PetscCall(ModelGetMotions(model, NULL, held));
  for (PetscInt i = 0; i < 3 * mesh->n_nodes; i++) nodal[i] += held[i];
  PetscCall(PetscFree(held));
  PetscFunctionReturn(0);
}

PetscErrorCode MotionsFlag(Model model, PetscBool fixed[][3])
{
  PetscReal *prescribed;
  PetscBT    taken;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(3 * model->mesh.n_nodes, &prescribed));
  model->mesh.prescribed = prescribed;
  PetscCall(PetscBTCreate(3 * model->mesh.n_nodes, &taken));
  for (PetscInt i = 0; i < model->scene.n_motions; i++)
    PetscCall(MotionFlag(model, &model->scene.motions[i], taken, fixed, prescribed));
  PetscCall(PetscBTDestroy(&taken));
  PetscFunctionReturn(0);
}
