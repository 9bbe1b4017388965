/*
   Names of shapes. The out-of-plane displacement w of the disc's nodes is fitted, by least squares weighted with nodal mass, as

      w(r, theta) = sum_m sum_j P_j(rho) (a_mj cos m theta + b_mj sin m theta),   m = 0..16, j = 0..4,

   P_j Legendre polynomials of the radius mapped to rho in [-1, 1], theta measured about the disc's axis from the contact. The
   nodal circles are the sign changes of the harmonics' radial profiles (the family of harmonics with most energy decides), the
   nodal diameters half the antinodes of that family around the rim, since a stiff contact mixes neighbouring harmonics, and
   cosine against sine tells an antinode at the contact (+). Axis and centre are those of the part's inertia tensor, so any mesh in any
   position serves. A mode is the disc's when the disc has at least a fifth of the kinetic energy and moves mostly out of
   plane; else it bears the name of the part with most energy.
*/
#include "modesimpl.h"
#include "disc.h"

#define DISC_SHARE 0.2 /* of the kinetic energy, from which on a mode is named after the disc's shape */

/* Nodal mass (kg) of one part, shape [local vertices]: an eighth of each of its hexahedra; only what this rank's cells give */
static PetscErrorCode PartMasses(Model model, PetscInt part, PetscReal **mass)
{
  const Element  *element;
  const Part     *parts;
  const PetscInt *cell_part;
  PetscInt        n_parts, cStart, cEnd, vStart, vEnd;
  DM              dm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetDM(model, &dm));
  PetscCall(ModelGetElement(model, &element));
  PetscCall(ModelGetParts(model, &n_parts, &parts));
  PetscCall(ModelGetCellParts(model, &cell_part));
  PetscCall(DMPlexGetHeightStratum(dm, 0, &cStart, &cEnd));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  PetscCall(PetscCalloc1(vEnd - vStart, mass));
  for (PetscInt c = 0; c < cEnd - cStart; c++) {
    PetscInt  vertices[ELEMENT_MAX_NODES];
    PetscReal x[ELEMENT_MAX_DOFS], volume, jacobian;

    if (cell_part[c] != part) continue;
    PetscCall(ModelGetCell(model, c, vertices, x));
    element->measure(x, &volume, &jacobian);
    for (PetscInt i = 0; i < element->n_nodes; i++)
      (*mass)[vertices[i] - vStart] += parts[part].density * volume / (PetscReal)element->n_nodes;
  }
  PetscFunctionReturn(0);
}

/* Displacements of a global vector at the local vertices, zeros at supports; array [local vertices][3] */
static PetscErrorCode NodalValues(DM dm, Vec global, PetscInt n_vertices, PetscReal values[])
{
  const PetscScalar *array;
  Vec                local;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(dm, &local));
  PetscCall(VecSet(local, 0));
  PetscCall(DMGlobalToLocal(dm, global, INSERT_VALUES, local));
  PetscCall(VecGetArrayRead(local, &array));
  PetscCall(PetscArraycpy(values, array, 3 * n_vertices));
  PetscCall(VecRestoreArrayRead(local, &array));
  PetscCall(DMRestoreLocalVector(dm, &local));
  PetscFunctionReturn(0);
}

/* Energy shares of the parts and the disc's fit of all modes, summed over ranks */
typedef struct {
  PetscInt   n_parts, n_vertices, disc; /* disc = its part, or -1 */
  PetscReal **mass;                     /* [part][local vertex] */
  PetscReal  *energy;                   /* [mode][part], then one more for the disc's out-of-plane part */
  Disc        frame;
} Labels;

/* Adds the energies and the disc's right-hand sides of one vector of mode i */
static PetscErrorCode LabelsAdd(Labels *l, PetscInt i, PetscInt column, const PetscReal u[])
{
  PetscReal *const energy = &l->energy[i * (l->n_parts + 1)];

  PetscFunctionBeginUser;
  for (PetscInt part = 0; part < l->n_parts; part++)
    for (PetscInt v = 0; v < l->n_vertices; v++)
      energy[part] += l->mass[part][v] * (u[3 * v] * u[3 * v] + u[3 * v + 1] * u[3 * v + 1] + u[3 * v + 2] * u[3 * v + 2]);
  if (l->disc >= 0) energy[l->n_parts] += DiscProject(&l->frame, column, u);
  PetscFunctionReturn(0);
}

/* Writes the name of mode i */
static PetscErrorCode LabelWrite(Modes modes, const Labels *l, const Part parts[], PetscInt i)
{
  const PetscReal *energy = &l->energy[i * (l->n_parts + 1)];
  PetscReal        total  = 0;
  PetscInt         most   = 0;
  Mode            *mode   = &modes->mode[i];

  PetscFunctionBeginUser;
  for (PetscInt part = 0; part < l->n_parts; part++) {
    total += energy[part];
    if (energy[part] > energy[most]) most = part;
  }
  if (l->disc >= 0 && energy[l->disc] > DISC_SHARE * total && energy[l->n_parts] > 0.5 * energy[l->disc] && !mode->rigid)
    PetscCall(DiscName(&l->frame, i, mode->label, sizeof(mode->label)));
  else PetscCall(PetscSNPrintf(mode->label, sizeof(mode->label), "%s%s", parts[most].name, mode->rigid ? " rigid" : ""));
  PetscFunctionReturn(0);
}

/* Masses, the disc's frame and fit; disc stays -1 where no part of that name exists or it is no disc */
static PetscErrorCode LabelsCreate(Modes modes, Model model, Contact contact, PetscInt n_parts, const Part parts[], Labels *l)
{
  const PetscReal *x;
  PetscReal        centre[3];
  PetscInt         vStart, vEnd;
  PetscBool        same, found;
  DM               dm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetDM(model, &dm));
  PetscCall(ModelGetCoordinates(model, &x));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &vStart, &vEnd));
  l->n_parts    = n_parts;
  l->n_vertices = vEnd - vStart;
  l->disc       = -1;
  PetscCall(PetscMalloc1(n_parts, &l->mass));
  PetscCall(PetscCalloc1(modes->n * (n_parts + 1), &l->energy));
  for (PetscInt part = 0; part < n_parts; part++) {
    PetscCall(PartMasses(model, part, &l->mass[part]));
    PetscCall(PetscStrcmp(parts[part].name, modes->disc, &same));
    if (same) l->disc = part;
  }
  if (l->disc < 0) PetscFunctionReturn(0);
  PetscCall(ContactGetCentre(contact, centre, &found));
  PetscCall(DiscCreate(modes->comm, l->n_vertices, x, l->mass[l->disc], found ? centre : NULL, modes->n, &l->frame, &same));
  if (!same) l->disc = -1;
  PetscFunctionReturn(0);
}

static PetscErrorCode LabelsDestroy(Labels *l)
{
  PetscFunctionBeginUser;
  for (PetscInt part = 0; part < l->n_parts; part++) PetscCall(PetscFree(l->mass[part]));
  PetscCall(PetscFree(l->mass));
  PetscCall(PetscFree(l->energy));
  PetscCall(DiscDestroy(&l->frame));
  PetscFunctionReturn(0);
}

/* Matrices without a mesh: the unknown that moves most */
static PetscErrorCode LabelUnknown(Modes modes)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < modes->n; i++) {
    PetscInt  at;
    PetscReal value;
    Vec       size;

    PetscCall(VecDuplicate(modes->right.xr[i], &size));
    PetscCall(VecPointwiseMult(size, modes->right.xr[i], modes->right.xr[i]));
    if (modes->right.xi[i]) {
      Vec part;

      PetscCall(VecDuplicate(size, &part));
      PetscCall(VecPointwiseMult(part, modes->right.xi[i], modes->right.xi[i]));
      PetscCall(VecAXPY(size, 1, part));
      PetscCall(VecDestroy(&part));
    }
    PetscCall(VecMax(size, &at, &value));
    PetscCall(VecDestroy(&size));
    PetscCall(PetscSNPrintf(modes->mode[i].label, sizeof(modes->mode[i].label), "u%" PetscInt_FMT, at + 1));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModesLabel(Modes modes)
{
  Labels      l = {0};
  const Part *parts;
  PetscInt    n_parts;
  PetscReal  *u;
  Model       model;
  Contact     contact;
  DM          dm;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(modes->operators, &model, &contact));
  if (!model) {
    PetscCall(LabelUnknown(modes));
    PetscFunctionReturn(0);
  }
  PetscCall(ModelGetDM(model, &dm));
  PetscCall(ModelGetParts(model, &n_parts, &parts));
  PetscCall(LabelsCreate(modes, model, contact, n_parts, parts, &l));
  PetscCall(PetscMalloc1(3 * l.n_vertices, &u));
  for (PetscInt i = 0; i < modes->n; i++) {
    PetscCall(NodalValues(dm, modes->right.xr[i], l.n_vertices, u));
    PetscCall(LabelsAdd(&l, i, 2 * i, u));
    if (!modes->right.xi[i]) continue;
    PetscCall(NodalValues(dm, modes->right.xi[i], l.n_vertices, u));
    PetscCall(LabelsAdd(&l, i, 2 * i + 1, u));
  }
  PetscCall(PetscFree(u));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, l.energy, (PetscMPIInt)(modes->n * (n_parts + 1)), MPIU_REAL, MPI_SUM, modes->comm));
  if (l.disc >= 0) PetscCall(DiscSolve(&l.frame));
  for (PetscInt i = 0; i < modes->n; i++) PetscCall(LabelWrite(modes, &l, parts, i));
  PetscCall(LabelsDestroy(&l));
  PetscFunctionReturn(0);
}
