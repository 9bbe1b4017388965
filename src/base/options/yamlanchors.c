/*
   Aliases of a YAML file, looked at before PETSc reads it: it says of a name that is not there neither file nor line,
   and twelve levels of lists of aliases would fill the memory.
*/
#include "yamlanchors.h"

#define ANCHORS_MAX_VALUES 100000 /* of a file, what aliases repeat included */

PetscErrorCode YamlAnchorsAdd(YamlAnchors *a, const yaml_char_t name[], PetscInt depth)
{
  YamlAnchor *now;

  PetscFunctionBeginUser;
  if (!name) PetscFunctionReturn(0);
  PetscCall(PetscRealloc((size_t)(a->n + 1) * sizeof(*a->anchor), &a->anchor));
  now  = &a->anchor[a->n++];
  *now = (YamlAnchor){
    .many = depth != YAML_VALUE ? PETSC_TRUE : PETSC_FALSE, .depth = depth, .first = a->n_values, .size = 1};
  PetscCall(PetscStrallocpy((const char *)name, &now->name));
  PetscFunctionReturn(0);
}

void YamlAnchorsEnd(YamlAnchors *a, PetscInt depth)
{
  for (PetscInt i = 0; i < a->n; i++) {
    if (a->anchor[i].depth != depth) continue;
    a->anchor[i].depth = YAML_VALUE;
    a->anchor[i].size  = a->n_values - a->anchor[i].first;
  }
}

PetscErrorCode YamlAnchorsCount(YamlAnchors *a, const char file[], size_t line, size_t more)
{
  PetscFunctionBeginUser;
  a->n_values += more;
  PetscCheck(a->n_values <= ANCHORS_MAX_VALUES, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s:%zu: more than %d values, with those that aliases (*) repeat", file, line, ANCHORS_MAX_VALUES);
  PetscFunctionReturn(0);
}

PetscErrorCode YamlAnchorsRepeat(YamlAnchors *a, const char file[], size_t line, PetscBool in_list, const char name[])
{
  const YamlAnchor *found = NULL;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < a->n; i++)
    if (!strcmp(a->anchor[i].name, name)) found = &a->anchor[i];
  PetscCheck(
    found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
    "%s:%zu: *%s repeats what has the name &%s, and nothing above has it; put a text that begins with * in quotes",
    file, line, name, name);
  PetscCheck(found->depth == YAML_VALUE, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s:%zu: *%s stands within what it repeats", file, line, name);
  PetscCheck(!in_list || !found->many, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s:%zu: a list holds *%s, which is a mapping or list; give values only", file, line, name);
  PetscCall(YamlAnchorsCount(a, file, line, found->size));
  PetscFunctionReturn(0);
}

PetscErrorCode YamlAnchorsDestroy(YamlAnchors *a)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < a->n; i++) PetscCall(PetscFree(a->anchor[i].name));
  PetscCall(PetscFree(a->anchor));
  PetscFunctionReturn(0);
}
