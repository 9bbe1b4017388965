/*
   Places: the force of 1 N, f = sum_d e_d of the node's unknowns with |e| = 1, and the displacements that are
   recorded, l_p^T u, as vectors of all unknowns. A probe is the nearest node of its part, in directions that
   neither a support nor a motion holds.
*/
#include "frfimpl.h"
#include <squeal/options.h>
#include <stdlib.h>
#include <string.h>

#define ALL_UNKNOWNS 10 /* of matrices without a mesh: up to so many are recorded without being named */

/* Index of a probe; errors name the option and list what is valid */
static PetscErrorCode ProbeFind(Frf frf, const ModelScene *scene, const char option[], const char name[],
                                PetscInt *index)
{
  char valid[2048] = "";

  PetscFunctionBeginUser;
  *index = -1;
  for (PetscInt i = 0; i < scene->n_probes; i++) {
    if (!strcmp(scene->probes[i].name, name)) *index = i;
    PetscCall(OptionsTextAppend(valid, i ? ", " : "", sizeof(valid)));
    PetscCall(OptionsTextAppend(valid, scene->probes[i].name, sizeof(valid)));
  }
  for (PetscInt i = 0; i < scene->n_circles && !strcmp(option, "-frf_probes"); i++) {
    PetscCall(OptionsTextAppend(valid, i ? ", " : valid[0] ? "; or -circles: " : "none; or -circles: ", sizeof(valid)));
    PetscCall(OptionsTextAppend(valid, scene->circles[i].name, sizeof(valid)));
  }
  PetscCheck(*index >= 0, frf->comm, PETSC_ERR_USER_INPUT, "%s '%s' is none of the -probes: %s", option, name,
             valid[0] ? valid : "there are none, give -probes NAME -NAME_at x,y,z");
  PetscFunctionReturn(0);
}

/* The direction of words x, y, z, or of three numbers, as a unit vector */
static PetscErrorCode DirectionParse(Frf frf, int n, char *words[], PetscReal direction[3])
{
  PetscReal length = 0;
  PetscBool good   = n == 1 || n == 3 ? PETSC_TRUE : PETSC_FALSE;
  char     *end;

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) direction[d] = n == 1 && words[0][0] == "xyz"[d] && !words[0][1] ? 1 : 0;
  for (int d = 0; d < 3 && n == 3; d++) {
    direction[d] = strtod(words[d], &end);
    if (end == words[d] || *end) good = PETSC_FALSE;
  }
  for (int d = 0; d < 3; d++) length += PetscSqr(direction[d]);
  length = PetscSqrtReal(length);
  PetscCheck(good && length > 0 && !PetscIsInfOrNanReal(length), frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_force %s: the direction must be x, y, z or three numbers that are not all zero", frf->force);
  for (int d = 0; d < 3; d++) direction[d] /= length;
  PetscFunctionReturn(0);
}

/* The force on a probe */
static PetscErrorCode ForceOnProbe(Frf frf, Model model, int n_words, char *words[])
{
  const ModelScene *scene;
  const Probe      *probe;
  PetscInt          index, unknown[3];
  PetscReal         direction[3];
  PetscBool         moves = PETSC_FALSE;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(model, &scene));
  PetscCall(ProbeFind(frf, scene, "-frf_force", words[0], &index));
  PetscCall(DirectionParse(frf, n_words - 1, words + 1, direction));
  probe = &scene->probes[index];
  PetscCall(OperatorsGetNodeUnknowns(frf->operators, probe->vertex, unknown));
  for (int d = 0; d < 3; d++)
    if (direction[d] != 0 && unknown[d] >= 0) moves = PETSC_TRUE;
  PetscCheck(moves, frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_force %s does nothing: the node at %.6g, %.6g, %.6g m is held in its direction", frf->force,
             (double)probe->x[0], (double)probe->x[1], (double)probe->x[2]);
  PetscCall(OperatorsAddEntries(frf->operators, frf->f, 3, unknown, direction));
  PetscCall(PetscSNPrintf(frf->input, sizeof(frf->input), "%s along %.6g, %.6g, %.6g", probe->name,
                          (double)direction[0], (double)direction[1], (double)direction[2]));
  PetscFunctionReturn(0);
}

PetscErrorCode FrfFindForce(Frf frf)
{
  const PetscReal one = 1;
  PetscInt        unknown;
  char          **words;
  int             n_words;
  Model           model;

  PetscFunctionBeginUser;
  PetscCheck(frf->force[0], frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_force must be given: a probe and x, y, z or three numbers, such as tip,z");
  PetscCall(OperatorsCreateVec(frf->operators, &frf->f));
  PetscCall(OperatorsGetModel(frf->operators, &model, NULL));
  PetscCall(ValuesSplit(frf->comm, "-frf_force", frf->force, ',', &n_words, &words));
  if (model) {
    PetscCall(ForceOnProbe(frf, model, n_words, words));
  } else {
    PetscCall(OperatorsFindUnknown(frf->operators, "-frf_force", frf->force, &unknown));
    PetscCall(OperatorsAddEntries(frf->operators, frf->f, 1, &unknown, &one));
    PetscCall(PetscSNPrintf(frf->input, sizeof(frf->input), "unknown %s", frf->force));
  }
  PetscCall(PetscStrToArrayDestroy(n_words, words));
  PetscFunctionReturn(0);
}

/* One more output: an unknown of all */
static PetscErrorCode OutputAdd(Frf frf, const char name[], PetscInt unknown)
{
  const PetscReal one = 1;
  const PetscInt  i   = frf->n_outputs;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(frf->output[i].name, name, sizeof(frf->output[i].name)));
  PetscCall(OperatorsCreateVec(frf->operators, &frf->l[i]));
  PetscCall(OperatorsAddEntries(frf->operators, frf->l[i], 1, &unknown, &one));
  frf->n_outputs++;
  PetscFunctionReturn(0);
}

/* The directions of a probe in which it is not held */
static PetscErrorCode OutputsOfProbe(Frf frf, const Probe *probe)
{
  const PetscInt before = frf->n_outputs;
  PetscInt       unknown[3];
  char           name[128];

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetNodeUnknowns(frf->operators, probe->vertex, unknown));
  for (int d = 0; d < 3; d++) {
    if (unknown[d] < 0 || !strchr(frf->directions, "xyz"[d])) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_%c", probe->name, "xyz"[d]));
    PetscCall(OutputAdd(frf, name, unknown[d]));
  }
  PetscCheck(frf->n_outputs > before, frf->comm, PETSC_ERR_USER_INPUT,
             "probe %s cannot answer: the node at %.6g, %.6g, %.6g m is held in %s; choose others by -frf_probes",
             probe->name, (double)probe->x[0], (double)probe->x[1], (double)probe->x[2], frf->directions);
  PetscFunctionReturn(0);
}

/* The nodes of a circle along its axis. Errors: one is held */
static PetscErrorCode OutputsOfCircle(Frf frf, const Circle *circle)
{
  PetscInt unknown[3];
  char     name[128];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < circle->n; k++) {
    const Probe *probe = &circle->probe[k];

    PetscCall(OperatorsGetNodeUnknowns(frf->operators, probe->vertex, unknown));
    PetscCheck(unknown[circle->axis] >= 0, frf->comm, PETSC_ERR_USER_INPUT,
               "circle %s cannot answer: the node at %.6g, %.6g, %.6g m is held in %c; choose others by -frf_probes",
               circle->name, (double)probe->x[0], (double)probe->x[1], (double)probe->x[2], "xyz"[circle->axis]);
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s_%c", probe->name, "xyz"[circle->axis]));
    PetscCall(OutputAdd(frf, name, unknown[circle->axis]));
  }
  PetscFunctionReturn(0);
}

/* Outputs of the probe or circle of a name */
static PetscErrorCode OutputsOfName(Frf frf, const ModelScene *scene, const char name[])
{
  PetscInt index;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < scene->n_circles; i++) {
    if (strcmp(scene->circles[i].name, name)) continue;
    PetscCall(OutputsOfCircle(frf, &scene->circles[i]));
    PetscFunctionReturn(0);
  }
  PetscCall(ProbeFind(frf, scene, "-frf_probes", name, &index));
  PetscCall(OutputsOfProbe(frf, &scene->probes[index]));
  PetscFunctionReturn(0);
}

/* Outputs of a mesh */
static PetscErrorCode OutputsOfModel(Frf frf, Model model)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(model, &scene));
  for (PetscInt i = 0; i < frf->n_places; i++) PetscCall(OutputsOfName(frf, scene, frf->place[i]));
  for (PetscInt i = 0; i < scene->n_probes && !frf->n_places; i++) PetscCall(OutputsOfProbe(frf, &scene->probes[i]));
  PetscFunctionReturn(0);
}

/* Outputs of matrices without a mesh */
static PetscErrorCode OutputsOfMatrices(Frf frf, PetscInt n)
{
  PetscInt unknown;
  char     name[32];

  PetscFunctionBeginUser;
  PetscCheck(frf->n_places || n <= ALL_UNKNOWNS, frf->comm, PETSC_ERR_USER_INPUT,
             "-frf_probes must be given for matrices of more than %d unknowns: their numbers, 1 to %" PetscInt_FMT,
             ALL_UNKNOWNS, n);
  for (PetscInt i = 0; i < (frf->n_places ? frf->n_places : n); i++) {
    unknown = i;
    if (frf->n_places) PetscCall(OperatorsFindUnknown(frf->operators, "-frf_probes", frf->place[i], &unknown));
    PetscCall(PetscSNPrintf(name, sizeof(name), "u%" PetscInt_FMT, unknown + 1));
    PetscCall(OutputAdd(frf, name, unknown));
  }
  PetscFunctionReturn(0);
}

/* Raises an error for a place that stands twice */
static PetscErrorCode PlacesCheck(Frf frf)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < frf->n_places; i++)
    for (PetscInt k = 0; k < i; k++)
      PetscCheck(strcmp(frf->place[i], frf->place[k]), frf->comm, PETSC_ERR_USER_INPUT, "-frf_probes names '%s' twice",
                 frf->place[i]);
  PetscFunctionReturn(0);
}

/* Raises an error for directions where no probe answers, which alone has some; scene NULL without a mesh */
static PetscErrorCode DirectionsCheckUsed(Frf frf, const ModelScene *scene)
{
  PetscBool used = scene && !frf->n_places ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; scene && i < frf->n_places; i++)
    for (PetscInt k = 0; k < scene->n_probes; k++)
      if (!strcmp(frf->place[i], scene->probes[k].name)) used = PETSC_TRUE;
  PetscCheck(!frf->has_directions || used, frf->comm, PETSC_ERR_USER_INPUT, "-frf_directions %s does nothing: %s",
             frf->directions,
             scene ? "-frf_probes names circles alone, each of which answers along its axis"
                   : "matrices without a mesh have unknowns, which -frf_probes chooses by their numbers");
  PetscFunctionReturn(0);
}

PetscErrorCode FrfFindOutputs(Frf frf)
{
  const ModelScene *scene = NULL;
  PetscInt          n, most;
  Model             model;

  PetscFunctionBeginUser;
  PetscCall(PlacesCheck(frf));
  PetscCall(OperatorsGetModel(frf->operators, &model, NULL));
  PetscCall(VecGetSize(frf->f, &n));
  if (model) PetscCall(ModelGetScene(model, &scene));
  PetscCall(DirectionsCheckUsed(frf, scene));
  most = scene ? 3 * PetscMax(frf->n_places, scene->n_probes) : PetscMax(frf->n_places, ALL_UNKNOWNS);
  for (PetscInt i = 0; scene && i < scene->n_circles; i++) most += scene->circles[i].n;
  PetscCall(PetscCalloc1(most, &frf->output));
  PetscCall(PetscCalloc1(most, &frf->l));
  if (model)
    PetscCall(OutputsOfModel(frf, model));
  else
    PetscCall(OutputsOfMatrices(frf, n));
  PetscFunctionReturn(0);
}

/* The force and the outputs in the unknowns of the pencil, fewer than all where constraints eliminate some: as
   forces from the right and from the left. */
PetscErrorCode FrfProject(Frf frf, Vec *right, Vec **left)
{
  PencilMatrices m;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMatrices(frf->pencil, &m));
  PetscCall(MatCreateVecs(m.K, right, NULL));
  PetscCall(VecDuplicateVecs(*right, frf->n_outputs, left));
  PetscCall(PencilProjectForce(frf->pencil, PETSC_FALSE, frf->f, *right));
  for (PetscInt p = 0; p < frf->n_outputs; p++)
    PetscCall(PencilProjectForce(frf->pencil, PETSC_TRUE, frf->l[p], (*left)[p]));
  PetscFunctionReturn(0);
}
