/*
   Names of shapes. Each direction of the displacement of the disc's nodes, w along its axis, u_r and u_theta in its
   plane, is fitted by least squares weighted with nodal mass, as

      w(r, theta) = sum_m sum_j P_j(rho) (a_mj cos m theta + b_mj sin m theta),   m = 0..16, j = 0..4,

   P_j Legendre polynomials of the radius mapped to rho in [-1, 1], theta measured about the disc's axis from the
   contact. Out of plane the nodal circles are the sign changes of the harmonics' radial profiles (the family of
   harmonics with most energy decides), the nodal diameters half the antinodes of that family around the rim, since a
   stiff contact mixes neighbouring harmonics, and cosine against sine tells an antinode at the contact (+). Axis and
   centre are those of the part's inertia tensor, so any mesh in any position serves. Where a contact surface goes all
   around the axis, only the ring from its least radius outward counts, not a hat inside of it. In plane: inplane.c.

   A mode is named after the disc's shape when the disc takes part with at least a quarter, out of plane or in plane
   as it moves more, else after the part that takes most part. Participation of part p is |y^T M_p x| from left and
   right vectors, the share of the part's mass in the eigenvalue's sensitivity: for real modes the share of kinetic
   energy; at a lock-in, where the right vector moves one body and the left one the other, about one half for each of
   the two (I. J. Perez-Arriaga et al., IEEE Trans. Power Apparatus and Systems 101, 1982: participation factors).

   What the name explains is the share of the ring's kinetic energy that the harmonic of the name fits alone, in its
   directions; of a mode that is named after a part the participation of the part.
*/
#include "modes/modesimpl.h"
#include "disc.h"
#include <ctype.h>
#include <string.h>

#define DISC_SHARE     0.25 /* participation from which on a mode is named after the disc's shape */
#define DISC_EXPLAINED 0.25 /* share of the ring's energy that a name in the plane has to explain */

/* Participation of the parts and the disc's fit of all modes, summed over ranks */
typedef struct {
  Operators         operators;
  PetscInt          n_parts, n_mesh; /* all with a name; of these in the mesh, the first; others are superelements */
  PetscMPIInt       rank;
  PetscInt          n_vertices, disc; /* disc = its part, or -1 */
  PetscBool         by_unknown;       /* what is no disc is named after the unknown that moves most */
  PetscReal *const *mass;             /* [part][local node] (borrowed) */
  PetscReal        *share;            /* [mode][part][2]: y^T M_p x, real and imaginary */
  PetscReal        *energy;           /* [mode][2]: the ring's kinetic energy of x, all and out of plane */
  PetscReal        *x[2], *y[2];      /* nodal values of one mode, real and imaginary [local nodes][3] */
  Disc             *frame;            /* of the weights; NULL without a disc */
} Labels;

/* sum_v m_v a_v . b_v */
static PetscReal WeightedDot(PetscInt n, const PetscReal m[], const PetscReal a[], const PetscReal b[])
{
  PetscReal sum = 0;

  for (PetscInt v = 0; v < n; v++)
    if (m[v] != 0) sum += m[v] * (a[3 * v] * b[3 * v] + a[3 * v + 1] * b[3 * v + 1] + a[3 * v + 2] * b[3 * v + 2]);
  return sum;
}

/* Adds participation and the disc's right-hand sides of mode i; without left vectors y = conj(x) */
static PetscErrorCode LabelsAdd(Modes modes, Operators operators, PetscInt i, Labels *l)
{
  PetscInt at;
  Vec      xr, xi, yr, yi;

  PetscFunctionBeginUser;
  PetscCall(ModesGetVectors(modes, i, &xr, &xi, &yr, &yi));
  PetscCall(OperatorsGetNodal(operators, xr, l->x[0]));
  PetscCall(OperatorsGetNodal(operators, xi, l->x[1]));
  PetscCall(OperatorsGetNodal(operators, yr ? yr : xr, l->y[0]));
  PetscCall(OperatorsGetNodal(operators, yr ? yi : xi, l->y[1]));
  for (PetscInt v = 0; v < 3 * l->n_vertices && !yr; v++) l->y[1][v] = -l->y[1][v];
  for (PetscInt part = 0; part < l->n_mesh; part++) {
    const PetscInt   n     = l->n_vertices;
    const PetscReal *m     = l->mass[part];
    PetscReal       *share = &l->share[2 * (i * l->n_parts + part)];

    share[0] = WeightedDot(n, m, l->y[0], l->x[0]);
    share[1] = 0;
    if (!xi && !(yr ? yi : xi)) continue; /* real */
    share[0] -= WeightedDot(n, m, l->y[1], l->x[1]);
    share[1] = WeightedDot(n, m, l->y[0], l->x[1]) + WeightedDot(n, m, l->y[1], l->x[0]);
  }
  for (PetscInt k = 0; k < l->n_parts - l->n_mesh; k++) {
    PetscReal *share = &l->share[2 * (i * l->n_parts + l->n_mesh + k)];

    PetscCall(LabelsShareSuperelement(modes, operators, k, (Vec[2]){xr, xi}, (Vec[2]){yr, yi}, share));
    if (l->rank) share[0] = share[1] = 0; /* it is that of all ranks */
  }
  at = 2 * (i * l->n_parts + l->disc);
  if (l->disc >= 0 && (l->share[at] != 0 || l->share[at + 1] != 0)) /* a free mode of another body does not move it */
    PetscCall(DiscProject(l->frame, i, (PetscReal *[2]){l->x[0], xi ? l->x[1] : NULL}, &l->energy[2 * i]));
  PetscFunctionReturn(0);
}

/* Name of a shape of the disc, and the share of the energy of the ring that it explains; none = no name, for a harmonic
   beyond the fit looks like any of it */
static PetscErrorCode LabelDisc(const Labels *l, PetscInt i, Mode *mode, double *explained, PetscBool *none)
{
  const PetscReal *energy = &l->energy[2 * i];
  PetscBool        axial  = energy[1] > (1 + LABEL_TIE) * 0.5 * energy[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscReal        fitted = 0;
  char             name[sizeof(mode->label)];

  PetscFunctionBeginUser;
  if (axial)
    PetscCall(DiscName(l->frame, i, name, sizeof(name), &fitted));
  else
    PetscCall(DiscNameInPlane(l->frame, i, name, sizeof(name), &fitted));
  *none = !axial && !(fitted > DISC_EXPLAINED * energy[0]) ? PETSC_TRUE : PETSC_FALSE;
  if (*none) PetscFunctionReturn(0);
  PetscCall(PetscStrncpy(mode->label, name, sizeof(name)));
  *explained = energy[0] > 0 ? fitted / energy[0] : 0;
  PetscFunctionReturn(0);
}

/* Writes the name of mode i, its participation and what its name explains, both in per cent */
static PetscErrorCode LabelWrite(Modes modes, const Labels *l, PetscInt i)
{
  double *const share = &modes->part_percent[i * l->n_parts], *explained = &modes->label_percent[i];
  PetscReal     total = 0;
  PetscInt      most  = 0;
  Mode         *mode  = &modes->mode[i];
  PetscBool     rigid = mode->rigid || mode->slowing ? PETSC_TRUE : PETSC_FALSE, unnamed = PETSC_TRUE;
  const char   *name;

  PetscFunctionBeginUser;
  for (PetscInt part = 0; part < l->n_parts; part++) {
    const PetscReal *z = &l->share[2 * (i * l->n_parts + part)];

    share[part] = PetscSqrtReal(z[0] * z[0] + z[1] * z[1]);
    total += share[part];
    if (share[part] > (1 + LABEL_TIE) * share[most]) most = part;
  }
  *explained = total > 0 ? share[most] / total : 0;
  if (l->disc >= 0 && share[l->disc] > (1 + LABEL_TIE) * DISC_SHARE * total && !rigid)
    PetscCall(LabelDisc(l, i, mode, explained, &unnamed));
  PetscCall(OperatorsGetPartName(l->operators, most, &name));
  if (unnamed && (!l->by_unknown || rigid))
    PetscCall(PetscSNPrintf(mode->label, sizeof(mode->label), "%s%s", name, rigid ? " rigid" : ""));
  for (PetscInt part = 0; part < l->n_parts; part++) share[part] = total > 0 ? 100 * (share[part] / total) : 0;
  modes->label_part[i] = unnamed && !l->by_unknown && !rigid ? most : -1;
  *explained           = unnamed && l->by_unknown && !rigid ? LABEL_UNKNOWN : 100 * *explained;
  PetscFunctionReturn(0);
}

/* Marks the local nodes on the surfaces of the contacts; free marks */
static PetscErrorCode SurfacesMark(Model model, Contact contact, PetscInt n_vertices, PetscBool **marks)
{
  const ContactInterface *interfaces;
  PetscInt                n_interfaces, n, *vertex;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n_vertices, marks));
  PetscCall(ContactGetInterfaces(contact, &n_interfaces, &interfaces));
  for (PetscInt i = 0; i < 2 * n_interfaces; i++) {
    PetscCall(ModelGetSetNodes(model, i % 2 ? interfaces[i / 2].master : interfaces[i / 2].slave, &n, &vertex));
    for (PetscInt k = 0; k < n; k++) (*marks)[vertex[k]] = PETSC_TRUE;
    PetscCall(PetscFree(vertex));
  }
  PetscFunctionReturn(0);
}

/* Whether points that nobody calls a disc are flat as one: a square bar has an axis too */
static PetscErrorCode PointsAreFlat(const Mesh *mesh, const Disc *disc, PetscBool *flat)
{
  PetscReal farthest = 0;

  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < mesh->n_nodes; v++) {
    PetscReal along = 0;

    for (int d = 0; d < 3; d++) along += (mesh->x[3 * v + d] - disc->centre[d]) * disc->axis[d];
    farthest = PetscMax(farthest, PetscAbsReal(along));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &farthest, 1, MPIU_REAL, MPI_MAX, disc->comm));
  *flat = farthest < 0.5 * disc->r_outer ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Whether a word stands in a name, between what are no letters */
static PetscErrorCode NameHasWord(const char name[], const char word[], PetscBool *has)
{
  const char *at = name;
  size_t      length;

  PetscFunctionBeginUser;
  PetscCall(PetscStrlen(word, &length));
  for (*has = PETSC_FALSE; !*has && (at = strstr(at, word)); at++)
    *has =
      (at == name || !isalpha((unsigned char)at[-1])) && !isalpha((unsigned char)at[length]) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Whether a part is the disc by a word of its name, in small or capital letters */
static PetscErrorCode NameIsDisc(const char part[], PetscBool *is_disc)
{
  static const char *const names[] = {"disc", "disk", "rotor", "drum"};
  char                     name[256];

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(name, part, sizeof(name)));
  PetscCall(PetscStrtolower(name));
  *is_disc = PETSC_FALSE;
  for (size_t i = 0; i < sizeof(names) / sizeof(names[0]) && !*is_disc; i++)
    PetscCall(NameHasWord(name, names[i], is_disc));
  PetscFunctionReturn(0);
}

/* The part of -modes_disc; where nothing is said and no part is called disc, the only one that is by its name; else
   -1 */
static PetscErrorCode LabelsNameDisc(Modes modes, const Mesh *mesh, PetscInt *disc)
{
  PetscInt  n = 0, by_name = -1;
  PetscBool same;

  PetscFunctionBeginUser;
  for (PetscInt part = 0; part < mesh->n_parts; part++) {
    PetscCall(PetscStrcmp(mesh->part[part], modes->disc, &same));
    if (same) *disc = part;
    PetscCall(NameIsDisc(mesh->part[part], &same));
    n += same;
    if (same) by_name = part;
  }
  PetscCheck(*disc >= 0 || !modes->has_disc, modes->comm, PETSC_ERR_USER_INPUT,
             "-modes_disc '%s' is none of the -parts", modes->disc);
  if (*disc < 0 && n == 1) *disc = by_name;
  PetscFunctionReturn(0);
}

/* The disc's frame and fit; disc stays -1 where no part of that name exists or it is no disc. Points without parts may
   be one */
static PetscErrorCode LabelsFindDisc(Modes modes, Model model, Contact contact, const Mesh *mesh, Labels *l)
{
  PetscReal centre[3];
  PetscBool same, found = PETSC_FALSE, *surface = NULL;

  PetscFunctionBeginUser;
  l->frame = modes->weights->disc;
  l->disc  = l->frame ? modes->weights->disc_part : -1;
  if (modes->weights->has_disc) PetscFunctionReturn(0);
  l->disc = model || mesh->n_parts > 1 ? -1 : 0;
  PetscCall(LabelsNameDisc(modes, mesh, &l->disc));
  if (l->disc < 0) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(1, &l->frame));
  if (model) PetscCall(ContactGetCentre(contact, centre, &found));
  if (model) PetscCall(SurfacesMark(model, contact, l->n_vertices, &surface));
  PetscCall(DiscCreate(modes->comm,
                       &(DiscPart){l->n_vertices, mesh->x, l->mass[l->disc], found ? centre : NULL, surface}, l->frame,
                       &same));
  PetscCall(PetscFree(surface));
  if (same && !model && mesh->n_parts == 1) PetscCall(PointsAreFlat(mesh, l->frame, &same));
  if (!same) {
    l->disc = -1;
    PetscCall(DiscDestroy(l->frame));
    PetscCall(PetscFree(l->frame));
  }
  modes->weights->disc      = l->frame;
  modes->weights->disc_part = l->disc;
  PetscFunctionReturn(0);
}

PetscErrorCode ModesFindDisc(Modes modes, const Disc **disc, const PetscReal **mass)
{
  Labels      l = {0};
  const Mesh *mesh;
  Operators   operators;
  Model       model;
  Contact     contact;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, &model, &contact));
  PetscCall(OperatorsGetMesh(operators, &mesh));
  l.n_vertices = mesh->n_nodes;
  PetscCall(LabelsWeigh(modes, mesh, &l.mass));
  PetscCall(LabelsFindDisc(modes, model, contact, mesh, &l));
  modes->weights->has_disc = PETSC_TRUE;
  *disc                    = l.frame;
  *mass                    = l.frame ? l.mass[l.disc] : NULL;
  PetscFunctionReturn(0);
}

/* Masses, room and the disc */
static PetscErrorCode LabelsCreate(Modes modes, Operators operators, const Mesh *mesh, Labels *l)
{
  Model   model;
  Contact contact;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetModel(operators, &model, &contact));
  l->operators = operators;
  l->n_mesh    = mesh->n_parts;
  PetscCall(OperatorsCountParts(operators, &l->n_parts));
  PetscCallMPI(MPI_Comm_rank(modes->comm, &l->rank));
  l->n_vertices = mesh->n_nodes;
  PetscCall(PetscCalloc2(2 * modes->n * l->n_parts, &l->share, 2 * modes->n, &l->energy));
  PetscCall(PetscMalloc4(3 * l->n_vertices, &l->x[0], 3 * l->n_vertices, &l->x[1], 3 * l->n_vertices, &l->y[0],
                         3 * l->n_vertices, &l->y[1]));
  PetscCall(LabelsWeigh(modes, mesh, &l->mass));
  PetscCall(LabelsFindDisc(modes, model, contact, mesh, l));
  modes->weights->has_disc = PETSC_TRUE;
  if (l->frame) PetscCall(DiscFitBegin(l->frame, modes->n));
  PetscFunctionReturn(0);
}

static PetscErrorCode LabelsDestroy(Labels *l)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(l->share, l->energy));
  PetscCall(PetscFree4(l->x[0], l->x[1], l->y[0], l->y[1]));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesLabel(Modes modes)
{
  Labels      l = {0};
  const Mesh *mesh;
  Model       model;
  Operators   operators;
  PetscInt    n;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, &model, NULL));
  PetscCall(OperatorsGetMesh(operators, &mesh));
  if (!mesh) {
    PetscCall(ModesLabelUnknowns(modes));
    PetscFunctionReturn(0);
  }
  PetscCall(LabelsCreate(modes, operators, mesh, &l));
  n            = modes->n * l.n_parts;
  l.by_unknown = !model && mesh->n_parts == 1 ? PETSC_TRUE : PETSC_FALSE; /* better than one name for all */
  if (l.by_unknown) PetscCall(ModesLabelUnknowns(modes));
  for (PetscInt i = 0; i < modes->n; i++) PetscCall(LabelsAdd(modes, operators, i, &l));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, l.share, (PetscMPIInt)(2 * n), MPIU_REAL, MPI_SUM, modes->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, l.energy, (PetscMPIInt)(2 * modes->n), MPIU_REAL, MPI_SUM, modes->comm));
  if (l.disc >= 0) PetscCall(DiscSolve(l.frame));
  PetscCall(PetscFree(modes->part_percent));
  PetscCall(PetscFree(modes->label_percent));
  PetscCall(PetscFree(modes->label_part));
  PetscCall(PetscMalloc1(n, &modes->part_percent));
  PetscCall(PetscMalloc1(modes->n, &modes->label_percent));
  PetscCall(PetscMalloc1(modes->n, &modes->label_part));
  for (PetscInt i = 0; i < modes->n; i++) PetscCall(LabelWrite(modes, &l, i));
  PetscCall(LabelsDestroy(&l));
  PetscFunctionReturn(0);
}
