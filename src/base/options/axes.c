/*
   Axes: words of -<owner>_parameter and -<owner>_link.
*/
#include "axes.h"
#include <squeal/options.h>
#include <string.h>

#define AXES_TEXT 64 /* length of an option's name */

/* Names so far, those of the axes first */
typedef struct {
  const AxesGiven *given;
  AxesAdd          add;
  void            *ctx;
  PetscInt         n_axes, n;
  char           **name; /* [n] */
  const char      *unit[AXES_MOST];
  PetscBool        linked[AXES_MOST];
  char             parameter[AXES_TEXT], link[AXES_TEXT], values[AXES_TEXT]; /* options */
} AxesReader;

static const char *UnitInWords(const char unit[])
{
  return unit[0] && strcmp(unit, "-") ? unit : "no unit";
}

/* A parameter of axis k, which `text` of the option names */
static PetscErrorCode AxesTake(AxesReader *r, const char option[], const char text[], const char name[], PetscInt k)
{
  const MPI_Comm comm = r->given->comm;
  const char    *unit;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < r->n; i++)
    PetscCheck(strcmp(r->name[i], name), comm, PETSC_ERR_USER_INPUT, "%s '%s' names '%s' twice", option, text, name);
  PetscCall(r->add(r->ctx, option, name, k, &unit));
  if (!r->unit[k]) r->unit[k] = unit;
  PetscCheck(!strcmp(r->unit[k], unit), comm, PETSC_ERR_USER_INPUT,
             "%s names %s, of %s, with %s, of %s: what takes the same values has the same unit", option, name,
             UnitInWords(unit), r->name[k], UnitInWords(r->unit[k]));
  PetscCall(PetscRealloc((size_t)(r->n + 1) * sizeof(*r->name), &r->name));
  PetscCall(PetscStrallocpy(name, &r->name[r->n++]));
  PetscFunctionReturn(0);
}

/* The axis of which a link holds the varied parameter */
static PetscErrorCode LinkFindAxis(AxesReader *r, const char text[], int n, char *const items[], PetscInt *axis)
{
  const AxesGiven *g = r->given;

  PetscFunctionBeginUser;
  *axis = -1;
  for (int i = 0; i < n; i++)
    for (PetscInt k = 0; k < r->n_axes; k++) {
      if (strcmp(items[i], r->name[k])) continue;
      PetscCheck(*axis < 0 || *axis == k, g->comm, PETSC_ERR_USER_INPUT,
                 "%s '%s' holds both parameters that are %s; it must hold one of them", r->link, text, g->varied);
      PetscCheck(!r->linked[k], g->comm, PETSC_ERR_USER_INPUT, "%s '%s' names '%s' twice", r->link, g->link, items[i]);
      *axis        = k;
      r->linked[k] = PETSC_TRUE;
    }
  PetscCheck(*axis >= 0, g->comm, PETSC_ERR_USER_INPUT, "%s '%s' does nothing: it must hold what is %s, %s %s", r->link,
             text, g->varied, r->parameter, g->parameter);
  PetscFunctionReturn(0);
}

/* Parameters that move with the varied one of a link */
static PetscErrorCode LinkRead(AxesReader *r, const char text[])
{
  PetscInt axis;
  char   **items;
  int      n;

  PetscFunctionBeginUser;
  PetscCall(ValuesSplit(r->given->comm, r->link, text, ',', &n, &items));
  PetscCheck(n > 1, r->given->comm, PETSC_ERR_USER_INPUT,
             "%s '%s' must name two or more parameters, e.g. inner_mu,outer_mu", r->link, text);
  PetscCall(LinkFindAxis(r, text, n, items, &axis));
  for (int i = 0; i < n; i++)
    if (strcmp(items[i], r->name[axis])) PetscCall(AxesTake(r, r->link, r->given->link, items[i], axis));
  PetscCall(PetscStrToArrayDestroy(n, items));
  PetscFunctionReturn(0);
}

static PetscErrorCode LinksRead(AxesReader *r)
{
  char **links;
  int    n;

  PetscFunctionBeginUser;
  if (!r->given->link) PetscFunctionReturn(0);
  PetscCall(ValuesSplit(r->given->comm, r->link, r->given->link, ':', &n, &links));
  PetscCheck(n > 0, r->given->comm, PETSC_ERR_USER_INPUT,
             "%s '%s' must name two or more parameters, e.g. inner_mu,outer_mu", r->link, r->given->link);
  for (int i = 0; i < n; i++) PetscCall(LinkRead(r, links[i]));
  PetscCall(PetscStrToArrayDestroy(n, links));
  PetscFunctionReturn(0);
}

PetscErrorCode AxesRead(const AxesGiven *g, AxesAdd add, void *ctx)
{
  AxesReader r = {.given = g, .add = add, .ctx = ctx};
  char     **names;
  int        n;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(r.parameter, sizeof(r.parameter), "-%s_parameter", g->owner));
  PetscCall(PetscSNPrintf(r.link, sizeof(r.link), "-%s_link", g->owner));
  PetscCall(PetscSNPrintf(r.values, sizeof(r.values), "-%s_values_2", g->owner));
  PetscCall(ValuesSplit(g->comm, r.parameter, g->parameter, ',', &n, &names));
  PetscCheck(n == 1 || n == AXES_MOST, g->comm, PETSC_ERR_USER_INPUT,
             "%s '%s' must name one or two options of the scene, e.g. contact_mu,pad_young", r.parameter, g->parameter);
  PetscCheck((n == AXES_MOST) == g->has_second, g->comm, PETSC_ERR_USER_INPUT,
             "%s belongs to a second %s: give both or neither", r.values, r.parameter);
  for (; r.n_axes < n; r.n_axes++) PetscCall(AxesTake(&r, r.parameter, g->parameter, names[r.n_axes], r.n_axes));
  PetscCall(PetscStrToArrayDestroy(n, names));
  PetscCall(LinksRead(&r));
  for (PetscInt i = 0; i < r.n; i++) PetscCall(PetscFree(r.name[i]));
  PetscCall(PetscFree(r.name));
  PetscFunctionReturn(0);
}
