/*
   Maxwell branches of the parts whose modulus is a Prony series (viscoelastic.h), as forces q_j of each part beside its
   K u, with K_p the stiffness of its static modulus E:

      dq_j/dt = (E_j / E) K_p v - q_j / tau_j,   f = -K u - C v - sum_j q_j.

   With the velocity of the step, which is constant in it, this is exact:

      q_j(t_{n+1}) = e^(-dt / tau_j) q_j(t_n) + (E_j / E) tau_j (1 - e^(-dt / tau_j)) K_p v_{n+1/2}.

   The scheme stays of second order in dt at any tau_j: a branch much slower than a step is a spring, one much faster
   the dashpot E_j tau_j, lagged by half a step as C v is. In the fastest oscillation, which changes its sign in every
   step, a branch is (E_j / E) K_p tanh(x) / x, x = dt / (2 tau_j): the critical step is that of the springs, x = 0,
   which is never longer. In the balance of energy work on branches is damping, what they store until they relax
   included. They begin relaxed, q = 0, as after a long rest.
*/
#include "bodiesimpl.h"

/* The branches of a material */
static PetscInt BranchesOf(const Viscoelastic *law, PetscReal stiff[], PetscReal time[])
{
  const PetscInt n = ViscoelasticBranches(law);

  for (PetscInt j = 0; j < n; j++) {
    stiff[j] = law->value[j] / law->young;
    time[j]  = law->value[n + j];
  }
  return n;
}

/* The nodes of a part, shared ones first, and its cells */
static PetscErrorCode BranchFindCells(Bodies b, MaxwellPart *branch, BodiesRowCells *cells)
{
  const Mesh *mesh = b->mesh;
  PetscBool  *has;

  PetscFunctionBeginUser;
  *cells = (BodiesRowCells){.n = 0};
  PetscCall(PetscMalloc2(b->layout.n_vertices, &cells->of_vertex, mesh->n_cells, &cells->cell));
  PetscCall(PetscCalloc1(b->layout.n_vertices, &has));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    if (mesh->cell_part[c] != branch->part) continue;
    cells->cell[cells->n++] = c;
    for (PetscInt a = 0; a < mesh->element[c]->n_nodes; a++) has[mesh->cell_node[mesh->cell_first[c] + a]] = PETSC_TRUE;
  }
  PetscCall(PetscMalloc1(b->layout.n_vertices, &branch->vertex));
  for (int shared = 1; shared >= 0; shared--) {
    for (PetscInt v = 0; v < b->layout.n_vertices; v++) {
      if (shared) cells->of_vertex[v] = -1;
      if (!has[v] || (b->share.shared[v] ? 1 : 0) != shared) continue;
      cells->of_vertex[v]         = branch->n;
      branch->vertex[branch->n++] = v;
    }
    if (shared) branch->n_early = branch->n;
  }
  cells->n_nodes = branch->n;
  PetscCall(PetscFree(has));
  PetscFunctionReturn(0);
}

/* The rows of K_p, and forces at rest */
static PetscErrorCode BranchSetUp(Bodies b, const Part *part, MaxwellPart *branch)
{
  BodiesRowCells cells;

  PetscFunctionBeginUser;
  branch->n_branches = BranchesOf(&part->law, branch->stiff, branch->time);
  PetscCall(BranchFindCells(b, branch, &cells));
  PetscCall(BlockRowsCreate(&cells, b->mesh, PETSC_FALSE, &branch->rows));
  for (PetscInt i = 0; i < cells.n; i++) {
    BodiesCell cell;

    PetscCall(BodiesGetCell(b, cells.cell[i], &cell));
    BodiesTurnCell(&b->layout, &cell);
    PetscCall(BlockRowsAdd(&cells, &cell, 1, &branch->rows));
  }
  PetscCall(PetscFree2(cells.of_vertex, cells.cell));
  PetscCall(PetscCalloc2(3 * branch->n + 1, &branch->motion, 3 * branch->n, &branch->product));
  PetscFunctionReturn(0);
}

PetscErrorCode BranchesSetUp(Bodies b)
{
  const ModelScene *scene;
  PetscInt          at = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(b->model, &scene));
  PetscCall(PetscCalloc1(scene->n_parts, &b->branch));
  for (PetscInt i = 0; i < scene->n_parts; i++) {
    if (BranchesStiffness(&scene->parts[i]) == 0) continue;
    b->branch[b->n_branches].part = i;
    PetscCall(BranchSetUp(b, &scene->parts[i], &b->branch[b->n_branches++]));
  }
  for (PetscInt i = 0; i < b->n_branches; i++) b->n_branch_forces += 3 * b->branch[i].n * b->branch[i].n_branches;
  PetscCall(PetscCalloc1(b->n_branch_forces, &b->branch_forces));
  for (PetscInt i = 0; i < b->n_branches; i++) {
    b->branch[i].force = &b->branch_forces[at];
    at += 3 * b->branch[i].n * b->branch[i].n_branches;
  }
  PetscFunctionReturn(0);
}

/* The motion of all nodes of a part */
static void BranchGather(const Layout *l, const MaxwellPart *branch, const PetscReal x[])
{
  for (PetscInt i = 0; i < branch->n; i++)
    for (int j = 0; j < 3; j++)
      branch->motion[3 * i + j] = x[l->at[branch->vertex[i]] + j * l->step[branch->vertex[i]]];
}

/* What a step of dt leaves of q, and adds to it of K_p v */
static void BranchSetStep(MaxwellPart *branch, PetscReal dt)
{
  if (branch->dt == dt) return;
  branch->dt = dt;
  for (PetscInt j = 0; j < branch->n_branches; j++) {
    const PetscReal x = -dt / branch->time[j];

    branch->decay[j] = PetscExpReal(x);
    branch->gain[j]  = -branch->stiff[j] * branch->time[j] * expm1(x);
  }
}

/* The forces of a part at the end of the step, of nodes begin .. end - 1 */
static void BranchAdvance(const Layout *l, const MaxwellPart *branch, PetscInt begin, PetscInt end, BodiesWork *w)
{
  BlockRowsMultiply(&branch->rows, begin, end, branch->motion, branch->product);
  for (PetscInt i = begin; i < end; i++) {
    for (PetscInt k = 3 * i; k < 3 * i + 3; k++) {
      const PetscInt at  = l->at[branch->vertex[i]] + (k - 3 * i) * l->step[branch->vertex[i]];
      PetscReal      sum = 0;

      for (PetscInt j = 0; j < branch->n_branches; j++) {
        PetscReal *q = &branch->force[3 * branch->n * j + k];

        *q = branch->decay[j] * *q + branch->gain[j] * branch->product[k];
        sum += *q;
      }
      w->d[at] += sum;
      w->f[at] -= sum;
      w->sums.damping += w->v[at] * sum;
    }
  }
}

void BranchesAdvance(Bodies b, PetscBool early, BodiesWork *w)
{
  for (PetscInt i = 0; i < b->n_branches; i++) {
    MaxwellPart *branch = &b->branch[i];

    if (early) {
      BranchSetStep(branch, w->dt);
      BranchGather(&b->layout, branch, w->v);
    }
    BranchAdvance(&b->layout, branch, early ? 0 : branch->n_early, early ? branch->n_early : branch->n, w);
  }
}

void BranchesAddStiffness(Bodies b, const PetscReal x[], PetscReal kx[])
{
  const Layout *l = &b->layout;

  for (PetscInt i = 0; i < b->n_branches; i++) {
    const MaxwellPart *branch = &b->branch[i];
    PetscReal          stiff  = 0;

    for (PetscInt j = 0; j < branch->n_branches; j++) stiff += branch->stiff[j];
    BranchGather(l, branch, x);
    BlockRowsMultiply(&branch->rows, 0, branch->n, branch->motion, branch->product);
    for (PetscInt k = 0; k < 3 * branch->n; k++)
      kx[l->at[branch->vertex[k / 3]] + k % 3 * l->step[branch->vertex[k / 3]]] += stiff * branch->product[k];
  }
}

PetscErrorCode BranchesDestroy(Bodies b)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < b->n_branches; i++) {
    MaxwellPart *branch = &b->branch[i];

    PetscCall(PetscFree(branch->vertex));
    PetscCall(BlockRowsDestroy(&branch->rows));
    PetscCall(PetscFree2(branch->motion, branch->product));
  }
  PetscCall(PetscFree(b->branch));
  PetscCall(PetscFree(b->branch_forces));
  PetscFunctionReturn(0);
}
