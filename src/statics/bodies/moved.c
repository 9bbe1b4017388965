/*
   What prescribed displacements d do to the pairs: with u = d on held directions contact displacements are w = G u + m,
   m = e . (d_m - d_s) along each row's direction e, so that the gap is g = g0 - m_n - (G u)_n, and slip counts from
   m of the load step before. An interference e (m) of the surfaces adds e (1 + kappa) to m_n: they approach by it along
   their normals before bodies yield, which is so much in the mean of a pair on curved faces (squeal/contact.h).
*/
#include "statics/staticsimpl.h"
#include "contact/bodies/moved.h"
#include "base/algebra/vec3.h"

/* m [rows] of what a stage prescribes; NULL where nothing is */
static PetscErrorCode MovedCreate(Model model, const Stage *stage, const PairRows *rows, PetscReal **moved)
{
  const Mesh  *mesh;
  PetscBool    overlaps = PETSC_FALSE;
  PetscInt     n        = 0;
  PetscReal   *nodal;
  MovedVertex *all = NULL;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < rows->n_interfaces; i++)
    if (stage->interference[i] != 0) overlaps = PETSC_TRUE;
  PetscCall(ModelGetMesh(model, &mesh));
  PetscCall(StageGetMotions(model, stage, &nodal));
  if (!nodal && !overlaps) PetscFunctionReturn(0);
  if (nodal) PetscCall(MovedVerticesGather(rows->comm, mesh, nodal, &n, &all));
  PetscCall(PetscMalloc1(rows->n, moved));
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const ContactPair *q    = &rows->pair[p];
    const PetscReal   *e[3] = {q->n, q->t, q->b};
    PetscReal          d[3];

    MovedApart(n, all, q, d);
    for (PetscInt i = 0; i < rows->law[p].d; i++) (*moved)[rows->first[p] + i] = Vec3Dot(e[i], d);
    (*moved)[rows->first[p]] += stage->interference[q->interface] * (1 + q->bend);
  }
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(nodal));
  PetscFunctionReturn(0);
}

PetscErrorCode PairRowsSetMoved(Model model, const Stage *before, const Stage *stage, PairRows *rows)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(rows->moved));
  PetscCall(PetscFree(rows->moved0));
  PetscCall(MovedCreate(model, stage, rows, &rows->moved));
  if (before) PetscCall(MovedCreate(model, before, rows, &rows->moved0));
  PetscFunctionReturn(0);
}

/* m of a row at a part of the way */
static PetscReal MovedAt(const PairRows *rows, PetscReal part, PetscInt i)
{
  const PetscReal end = rows->moved ? part * rows->moved[i] : 0;

  return rows->moved0 ? end + (1 - part) * rows->moved0[i] : end;
}

/* At a part of the way g0 = gap + worn - m_n. Slip counts from w + m of the part before: in w, which has no m, from w
   less what m has grown by. */
void PairRowsMove(PairRows *rows, PetscReal part, PetscReal before, const PetscReal w[])
{
  for (PetscInt p = 0; p < rows->n_pairs; p++) {
    const PetscInt first = rows->first[p];
    CoulombPair   *law   = &rows->law[p];

    law->g0 = rows->pair[p].gap + (rows->worn ? rows->worn[p] : 0) - MovedAt(rows, part, first);
    for (PetscInt i = 1; i < 3; i++) law->slip0[i - 1] = 0;
    for (PetscInt i = 1; i < law->d; i++)
      law->slip0[i - 1] = (w ? w[first + i] : 0) - (MovedAt(rows, part, first + i) - MovedAt(rows, before, first + i));
  }
}
