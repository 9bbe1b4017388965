/*
   Names of the free modes of the bodies, and by them of modes that are named after a part.

   A free mode of the disc has the name of the disc's shape; one of another body that of its kind (label/solid.c) with
   its number among those of the kind in the body, by frequency. Of a uniform beam bending n has n + 1 nodes, torsion n
   and longitudinal n have n. What is of no kind is "elastic n", the n-th of all that are not at zero.

   A mode that is named after a part p, of body b, gets the name of the free mode of b that is most alike by the
   assurance criterion with the mass matrix, "p bending 1":

      MAC = sum_k |phi_k' M_b x|^2 / x^H M_b x,   phi_k' M_b phi_k = 1,   k over free modes of one frequency.

   Where these are the free rigid motions it is "p rigid body", unlike "p rigid", a mode at zero. MAC is also what the
   name explains. Where it is less than a quarter the mode is called p alone, as without free modes.
*/
#include "components.h"
#include "modes/label/solid.h"
#include <string.h>

#define NAME_LEAST 0.25 /* MAC of a free mode that gives a name */

/* What names are made of */
typedef struct {
  Modes       free;
  Operators   operators;
  const Mesh *mesh;
  PetscReal  *nodal;  /* [local nodes][3] of one free mode */
  PetscReal **mass;   /* [bodies][local nodes] kg, NULL as long as no name asks */
  SolidFrame *solid;  /* [bodies] */
  PetscReal  *energy; /* [levels][bodies][N_SOLID_KINDS] as of SolidAddEnergies() */
} Names;

/* phi' M_b phi of the bodies: free modes from the modes found are each of one */
static PetscErrorCode FreeModesLocate(const Modes free, Mat M, const ModesComponents c, PetscReal own[])
{
  const PetscInt n = c->bodies.n;
  Vec            x, Mx;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < free->n && c->found; k++) own[k * n + c->found_of[k]] = 1;
  if (c->found) PetscFunctionReturn(0);
  PetscCall(MatCreateVecs(M, NULL, &Mx));
  for (PetscInt k = 0; k < free->n; k++) {
    PetscCall(ModesGetVectors(free, k, &x, NULL, NULL, NULL));
    PetscCall(MatMult(M, x, Mx));
    PetscCall(FreeBodiesAddDot(&c->bodies, x, Mx, &own[k * n]));
  }
  PetscCall(VecDestroy(&Mx));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, own, (PetscMPIInt)(free->n * n), MPIU_REAL, MPI_SUM, free->comm));
  PetscFunctionReturn(0);
}

/* Nodal masses and frame of body b, once, where a name asks for them */
static PetscErrorCode NamesNeedSolid(PetscInt b, const FreeBodies *bodies, PetscReal *const part_mass[], Names *names)
{
  const Mesh *mesh = names->mesh;
  PetscReal  *mass;

  PetscFunctionBeginUser;
  if (names->mass[b]) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(mesh->n_nodes + 1, &mass));
  for (PetscInt p = 0; p < mesh->n_parts; p++)
    for (PetscInt v = 0; v < mesh->n_nodes && bodies->of_part[p] == b; v++) mass[v] += part_mass[p][v];
  PetscCall(SolidCreate(names->free->comm, mesh->n_nodes, mesh->x, mass, &names->solid[b]));
  names->mass[b] = mass;
  PetscFunctionReturn(0);
}

/* The name of the disc's shape in a level of a body, without the contact's + where it is any of a plane; "" for none */
static PetscErrorCode DiscNameFind(const ModesComponents c, const Names *names, const FreeLevel *level, PetscInt b,
                                   char name[32])
{
  char *plus;

  PetscFunctionBeginUser;
  name[0] = 0;
  for (PetscInt k = level->first; k < level->first + level->n && !name[0]; k++) {
    const char *label = names->free->mode[k].label;

    if (c->own[k * c->bodies.n + b] > 0.5 && (label[0] == '(' || !strncmp(label, "IP-", 3)))
      PetscCall(PetscStrncpy(name, label, 32));
  }
  plus = level->n > 1 ? strchr(name, '+') : NULL;
  if (plus) *plus = ')', plus[1] = 0;
  PetscFunctionReturn(0);
}

/* Energies of the kinds of all levels, but those with the name of the disc */
static PetscErrorCode NamesMeasure(Modes modes, const ModesComponents c, Names *names)
{
  const PetscInt    n = c->bodies.n;
  PetscReal *const *mass;
  char              disc[32];

  PetscFunctionBeginUser;
  PetscCall(LabelsWeigh(modes, names->mesh, &mass));
  for (PetscInt l = 0; l < c->n_levels; l++)
    for (PetscInt k = c->level[l].first; k < c->level[l].first + c->level[l].n && !c->level[l].rigid; k++) {
      Vec x;

      PetscCall(ModesGetVectors(names->free, k, &x, NULL, NULL, NULL));
      PetscCall(OperatorsGetNodal(names->operators, x, names->nodal));
      for (PetscInt b = 0; b < n; b++) {
        if (!(c->own[k * n + b] > LABEL_TIE)) continue; /* alike on all ranks */
        PetscCall(DiscNameFind(c, names, &c->level[l], b, disc));
        if (disc[0]) continue;
        PetscCall(NamesNeedSolid(b, &c->bodies, mass, names));
        PetscCall(SolidAddEnergies(&names->solid[b], names->nodal, &names->energy[(l * n + b) * N_SOLID_KINDS]));
      }
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode NamesCreate(Modes modes, const Modes free, const ModesComponents c, Names *names)
{
  const PetscInt n = c->bodies.n;

  PetscFunctionBeginUser;
  *names = (Names){.free = free};
  PetscCall(PencilGetOperators(modes->pencil, &names->operators));
  PetscCall(OperatorsGetMesh(names->operators, &names->mesh));
  PetscCall(PetscCalloc2(3 * names->mesh->n_nodes, &names->nodal, c->n_levels * n * N_SOLID_KINDS, &names->energy));
  PetscCall(PetscCalloc2(n, &names->mass, n, &names->solid));
  PetscCall(NamesMeasure(modes, c, names));
  PetscFunctionReturn(0);
}

static PetscErrorCode NamesDestroy(PetscInt n_bodies, Names *names)
{
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < n_bodies; b++) {
    if (!names->mass[b]) continue;
    PetscCall(SolidDestroy(&names->solid[b]));
    PetscCall(PetscFree(names->mass[b]));
  }
  PetscCall(PetscFree2(names->mass, names->solid));
  PetscCall(PetscFree2(names->nodal, names->energy));
  PetscFunctionReturn(0);
}

/* How many levels of each kind a body had so far; of SOLID_NONE its modes */
typedef PetscInt KindCounts[N_SOLID_KINDS];

static PetscErrorCode FreeLevelName(const ModesComponents c, const Names *names, PetscInt l, PetscInt b,
                                    KindCounts counts, FreeMode *is)
{
  const SolidKind kind = SolidJudge(&names->energy[(l * c->bodies.n + b) * N_SOLID_KINDS]);

  PetscFunctionBeginUser;
  if (c->level[l].rigid) {
    PetscCall(PetscStrncpy(is->name, "rigid", sizeof(is->name)));
    PetscFunctionReturn(0);
  }
  PetscCall(DiscNameFind(c, names, &c->level[l], b, is->name));
  if (!is->name[0])
    PetscCall(PetscSNPrintf(is->name, sizeof(is->name), "%s %" PetscInt_FMT, SolidKindName(kind), counts[kind] + 1));
  counts[SOLID_NONE] += is->n;
  if (is->n && kind) counts[kind]++;
  PetscFunctionReturn(0);
}

PetscErrorCode FreeLevelsName(Modes modes, const Modes free, Mat M, ModesComponents c)
{
  const PetscInt n = c->bodies.n;
  KindCounts    *counts;
  PetscInt      *number;
  Names          names;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(c->n_levels * n, &c->free));
  PetscCall(PetscCalloc2(n, &number, n, &counts));
  PetscCall(PetscCalloc1(free->n * n, &c->own));
  PetscCall(FreeModesLocate(free, M, c, c->own));
  PetscCall(NamesCreate(modes, free, c, &names));
  for (PetscInt i = 0; i < c->n_levels * n; i++) {
    const FreeLevel *level = &c->level[i / n];
    FreeMode        *is    = &c->free[i];
    PetscReal        sum   = 0;

    for (PetscInt k = level->first; k < level->first + level->n; k++) sum += c->own[k * n + i % n];
    is->n     = (PetscInt)(sum + 0.5);
    is->first = number[i % n];
    PetscCall(FreeLevelName(c, &names, i / n, i % n, counts[i % n], is));
    number[i % n] += is->n;
  }
  PetscCall(NamesDestroy(n, &names));
  PetscCall(PetscFree2(number, counts));
  PetscFunctionReturn(0);
}

/* Name of mode i after a free mode of the body of a part; a long name of the part loses its end */
static PetscErrorCode ModeLabel(Modes modes, PetscInt i, const char part[], PetscInt b)
{
  const ModesComponents c      = modes->components;
  const PetscReal      *energy = &c->energy[i * (c->n_levels + 1) * c->bodies.n];
  const PetscReal       whole  = energy[c->n_levels * c->bodies.n + b];
  const char           *name;
  Mode                 *mode = &modes->mode[i];
  PetscReal             most = NAME_LEAST * whole;
  PetscInt              best = -1;
  size_t                length;

  PetscFunctionBeginUser;
  for (PetscInt l = 0; l < c->n_levels; l++) {
    if (!c->free[l * c->bodies.n + b].n || !(energy[l * c->bodies.n + b] > (1 + LABEL_TIE) * most)) continue;
    most = energy[l * c->bodies.n + b];
    best = l;
  }
  if (best < 0) PetscFunctionReturn(0);
  name = c->level[best].rigid ? "rigid body" : c->free[best * c->bodies.n + b].name;
  PetscCall(PetscStrlen(name, &length));
  PetscCall(
    PetscSNPrintf(mode->label, sizeof(mode->label), "%.*s %s", (int)(sizeof(mode->label) - 2 - length), part, name));
  modes->label_percent[i] = 100 * (most / whole);
  PetscFunctionReturn(0);
}

PetscBool ComponentsAsks(const Modes modes, PetscInt i)
{
  return modes->mode[i].unstable || modes->label_part[i] >= 0 ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ComponentsLabel(Modes modes)
{
  const FreeBodies *bodies = &modes->components->bodies;
  Operators         operators;
  const char       *name;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  for (PetscInt i = 0; i < modes->n; i++) {
    const PetscInt part = modes->label_part[i];

    if (part < 0 || bodies->of_part[part] < 0) continue;
    PetscCall(OperatorsGetPartName(operators, part, &name));
    PetscCall(ModeLabel(modes, i, name, bodies->of_part[part]));
  }
  PetscFunctionReturn(0);
}
