/*
   Columns of a file of conditions as variables: a column is the parameter of its name, or what -sample_columns say of
   it,

      p_i = a x,   p_i = a x p_i0 where it is relative,   p_i = f(a x) p_i0 by a table,   a = unit * scale,

   p_i0 the scene's own value. Where the disc turns the other way (direction reverse), friction coefficients of contacts
   that slide, and the spins of parts, have the other sign.
*/
#include "sample/sampleimpl.h"
#include <string.h>

/* The place of a column, -1 for none */
static PetscInt ColumnFind(const ConditionTable *t, const char name[])
{
  for (PetscInt c = 0; c < t->n_columns; c++)
    if (!strcmp(t->column[c], name)) return c;
  return -1;
}

/* Raises an error for a mapping or a name to ignore that the file has no column for */
static PetscErrorCode ColumnsCheck(Sample s, PetscInt n, SampleVariable given[])
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++) {
    if (!given[k].source[0]) PetscCall(PetscStrncpy(given[k].source, given[k].name, sizeof(given[k].source)));
    given[k].column = ColumnFind(&s->conditions, given[k].source);
    PetscCheck(given[k].column >= 0, s->comm, PETSC_ERR_USER_INPUT,
               "-sample_columns %s: %s has no column '%s' of numbers", given[k].name, s->file, given[k].source);
    PetscCheck(given[k].n_names, s->comm, PETSC_ERR_USER_INPUT,
               "-sample_columns %s needs -%s_parameters: options of the scene that take its value", given[k].name,
               given[k].name);
    PetscCheck(!given[k].table[0] || !given[k].relative, s->comm, PETSC_ERR_USER_INPUT,
               "-%s_table has factors of the scene's own values already: leave out -%s_relative", given[k].name,
               given[k].name);
  }
  for (PetscInt k = 0; k < s->n_ignored; k++)
    PetscCheck(ColumnFind(&s->conditions, s->ignored[k]) >= 0, s->comm, PETSC_ERR_USER_INPUT,
               "-sample_ignore: %s has no column '%s' of numbers", s->file, s->ignored[k]);
  PetscFunctionReturn(0);
}

/* Whether a column is left out */
static PetscBool ColumnIsIgnored(Sample s, const char name[])
{
  for (PetscInt k = 0; k < s->n_ignored; k++)
    if (!strcmp(s->ignored[k], name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A column that is the parameter of its own name */
static PetscErrorCode ColumnOwn(Sample s, PetscInt c, SampleVariable *v)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesInit(sample_columns.table, v));
  PetscCall(PetscStrallocpy(s->conditions.column[c], &v->name));
  v->column = c;
  PetscFunctionReturn(0);
}

/* Variables in the order of the file, what several options say of one column in theirs */
PetscErrorCode ConditionsSetColumns(Sample s)
{
  const ConditionTable *t       = &s->conditions;
  SampleVariable       *given   = s->column;
  const PetscInt        n_given = s->n_columns;

  PetscFunctionBeginUser;
  PetscCall(ColumnsCheck(s, n_given, given));
  PetscCall(PetscCalloc1(n_given + t->n_columns, &s->variable));
  s->n_variables = 0;
  for (PetscInt c = 0; c < t->n_columns; c++) {
    PetscBool found = PETSC_FALSE;

    for (PetscInt k = 0; k < n_given; k++)
      if (given[k].column == c) {
        s->variable[s->n_variables++] = given[k];
        found                         = PETSC_TRUE;
      }
    if (!found && !ColumnIsIgnored(s, t->column[c])) PetscCall(ColumnOwn(s, c, &s->variable[s->n_variables++]));
  }
  PetscCheck(s->n_variables || t->reverses, s->comm, PETSC_ERR_USER_INPUT,
             "-sample_conditions %s: it has no column that changes anything", s->file);
  PetscFunctionReturn(0);
}

PetscErrorCode SampleColumnCheck(MPI_Comm comm, void *owner, void *record)
{
  SampleVariable *v = record;
  Distribution   *d = &v->distribution;

  PetscFunctionBeginUser;
  (void)owner;
  if (!v->table[0]) PetscFunctionReturn(0);
  PetscCall(SampleTableRead(comm, v, "factor", d));
  for (PetscInt k = 1; k < d->n; k++)
    PetscCheck(d->value[k] > d->value[k - 1], comm, PETSC_ERR_USER_INPUT,
               "-%s_table %s: value must ascend, which %.6g behind %.6g does not", v->name, v->table,
               (double)d->value[k], (double)d->value[k - 1]);
  PetscFunctionReturn(0);
}

/* The factor of a table at x, straight between its rows */
static PetscErrorCode TableFactorAt(Sample s, const SampleVariable *v, PetscInt i, PetscReal x, PetscReal *factor)
{
  const Distribution *d = &v->distribution;
  PetscInt            k = 1;

  PetscFunctionBeginUser;
  PetscCheck(x >= d->value[0] && x <= d->value[d->n - 1], s->comm, PETSC_ERR_USER_INPUT,
             "-sample_conditions %s, condition %s: %s %.6g is outside of -%s_table %s, which goes from %.6g to %.6g",
             s->file, s->conditions.name[i], v->source[0] ? v->source : v->name, (double)x, v->name, v->table,
             (double)d->value[0], (double)d->value[d->n - 1]);
  while (k < d->n - 1 && x > d->value[k]) k++;
  *factor = d->probability[k - 1] +
            (d->probability[k] - d->probability[k - 1]) * (x - d->value[k - 1]) / (d->value[k] - d->value[k - 1]);
  PetscFunctionReturn(0);
}

/* Raises an error where a column is the parameter itself, and its unit is none of it, as bar of a force */
PetscErrorCode ConditionsCheckUnit(Sample s, const SampleVariable *v, const OperatorsParameter *parameter)
{
  const char *si = s->conditions.si[v->column], *unit = parameter->unit ? parameter->unit : "";

  PetscFunctionBeginUser;
  if (!si || v->table[0] || v->relative || v->scale != 1) PetscFunctionReturn(0);
  PetscCheck(!strcmp(si, unit[0] ? unit : "1"), s->comm, PETSC_ERR_USER_INPUT,
             "-sample_conditions %s, column %s: %s is in %s, not in %s; -sample_columns %s with -%s_scale converts",
             s->file, s->conditions.head[v->column], parameter->name, unit[0] ? unit : "no unit", si, v->name, v->name);
  PetscFunctionReturn(0);
}

PetscErrorCode ConditionsGet(Sample s, PetscInt i, PetscReal p[])
{
  const ConditionTable *t = &s->conditions;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n_variables; k++) {
    const SampleVariable *v = &s->variable[k];
    PetscReal             x = t->value[i * t->n_columns + v->column] * t->unit[v->column] * v->scale;

    if (v->table[0]) PetscCall(TableFactorAt(s, v, i, x, &x));
    for (PetscInt m = 0; m < v->n_names; m++)
      p[v->moved[m]] = v->relative || v->table[0] ? x * s->box.nominal[v->moved[m]] : x;
  }
  for (PetscInt m = 0; m < s->n_reversed; m++) p[s->reversed[m]] *= t->direction[i];
  PetscFunctionReturn(0);
}

/* Whether a parameter has the name of a thing and of what it is: "disc", "_spin" */
static PetscBool ParameterIs(const OperatorsParameter *q, const char name[], const char what[])
{
  const size_t length = strlen(name);

  return !strncmp(q->name, name, length) && !strcmp(q->name + length, what) ? PETSC_TRUE : PETSC_FALSE;
}

/* Friction coefficients of contacts that slide, and spins. A law of mu(v) has no sign that could be turned */
PetscErrorCode ConditionsFindReversed(Sample s)
{
  const OperatorsParameter *list;
  const ContactInterface   *c = NULL;
  const ModelScene         *scene;
  PetscInt                  n, n_contacts = 0;
  Model                     model;
  Contact                   contact;

  PetscFunctionBeginUser;
  if (!s->conditions.reverses) PetscFunctionReturn(0);
  PetscCall(OperatorsGetParameters(s->operators, &n, &list));
  PetscCall(PetscMalloc1(n, &s->reversed));
  PetscCall(OperatorsGetModel(s->operators, &model, &contact));
  if (contact) PetscCall(ContactGetInterfaces(contact, &n_contacts, &c));
  if (model) PetscCall(ModelGetScene(model, &scene));
  for (PetscInt k = 0; k < n_contacts; k++)
    PetscCheck(!c[k].slides || !FrictionVaries(&c[k].friction), s->comm, PETSC_ERR_USER_INPUT,
               "-sample_conditions %s: a column direction needs friction that does not change with the speed, which "
               "that of contact %s does",
               s->file, c[k].name);
  for (PetscInt i = 0; i < n; i++) {
    PetscBool turns = PETSC_FALSE;

    for (PetscInt k = 0; k < n_contacts && !turns; k++)
      turns = c[k].slides ? ParameterIs(&list[i], c[k].name, "_mu") : PETSC_FALSE;
    for (PetscInt k = 0; model && k < scene->n_parts && !turns; k++)
      turns = ParameterIs(&list[i], scene->parts[k].name, "_spin");
    if (!model && (!strcmp(list[i].name, "contact_mu"))) turns = PETSC_TRUE;
    if (turns) s->reversed[s->n_reversed++] = i;
  }
  PetscCheck(s->n_reversed, s->comm, PETSC_ERR_USER_INPUT,
             "-sample_conditions %s: a column direction changes nothing, as no contact slides and no part spins",
             s->file);
  PetscFunctionReturn(0);
}
