/* Laws of viscoelastic materials from their options */
#include "viscoelasticimpl.h"

/* Raises an error for options of a series or of Zener's law that do not go together */
static PetscErrorCode AskedCheck(MPI_Comm comm, const char name[], const ViscoelasticAsked *v)
{
  PetscFunctionBeginUser;
  PetscCheck(v->n_modulus == v->n_time, comm, PETSC_ERR_USER_INPUT,
             "-%s_prony_modulus and -%s_prony_time must have as many values, a modulus (Pa) and a time (s) for each "
             "branch, not %" PetscInt_FMT " and %" PetscInt_FMT,
             name, name, v->n_modulus, v->n_time);
  for (int k = 0; k < 3; k++)
    PetscCheck(v->has_zener[k] == v->has_zener[0], comm, PETSC_ERR_USER_INPUT,
               "-%s_zener_modulus (Pa), -%s_zener_time (s) and -%s_zener_order (0 to 1) make one law: give all three",
               name, name, name);
  PetscCheck(!v->has_zener[2] || v->zener[2] > 0, comm, PETSC_ERR_USER_INPUT,
             "-%s_zener_order %.6g must exceed 0, and be 1 at most", name, (double)v->zener[2]);
  PetscCheck(!v->has_temperature || v->has_file, comm, PETSC_ERR_USER_INPUT,
             "-%s_table_temperature does nothing without -%s_table, a file", name, name);
  PetscFunctionReturn(0);
}

/* Raises an error for more than one law; none = there is none */
static PetscErrorCode AskedCount(MPI_Comm comm, const char name[], const ViscoelasticAsked *v, PetscReal loss,
                                 PetscBool *none)
{
  const struct {
    const char *what;
    PetscBool   given;
  } law[]   = {{"loss_factor without -model_loss_frequency", (PetscBool)(loss > 0)},
               {"prony_modulus", (PetscBool)(v->n_modulus > 0)},
               {"zener_modulus", v->has_zener[0]},
               {"table", v->has_file},
               {"table_frequency", (PetscBool)(v->n_listed[0] + v->n_listed[1] + v->n_listed[2] > 0)}};
  int first = -1;

  PetscFunctionBeginUser;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(law); k++) {
    if (!law[k].given) continue;
    PetscCheck(first < 0, comm, PETSC_ERR_USER_INPUT, "-%s_%s and -%s_%s exclude each other: there is one law", name,
               law[first].what, name, law[k].what);
    first = (int)k;
  }
  *none = first < 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(0);
}

PetscErrorCode ViscoelasticSet(MPI_Comm comm, const char name[], const ViscoelasticAsked *v, PetscReal young,
                               PetscReal loss, Viscoelastic *law)
{
  PetscBool none;

  PetscFunctionBeginUser;
  *law = (Viscoelastic){.kind = VISCOELASTIC_NONE, .young = young};
  PetscCall(AskedCheck(comm, name, v));
  PetscCall(AskedCount(comm, name, v, loss, &none));
  if (none) PetscFunctionReturn(0);
  PetscCheck(loss <= VISCOELASTIC_LOSS_MOST, comm, PETSC_ERR_USER_INPUT,
             "-%s_loss_factor %.6g must be at most %d where it is hysteretic: no material has more", name, (double)loss,
             VISCOELASTIC_LOSS_MOST);
  if (loss > 0) law->kind = VISCOELASTIC_HYSTERETIC, law->n = 1, law->value[0] = loss;
  if (v->n_modulus) law->kind = VISCOELASTIC_PRONY, law->n = 2 * v->n_modulus;
  if (v->has_zener[0]) law->kind = VISCOELASTIC_ZENER, law->n = 3;
  for (PetscInt j = 0; j < v->n_modulus; j++) {
    law->value[j]                = v->modulus[j];
    law->value[v->n_modulus + j] = v->time[j];
  }
  if (v->has_zener[0]) PetscCall(PetscArraycpy(law->value, v->zener, 3));
  if (!law->kind) PetscCall(ViscoelasticReadTable(comm, name, v, law));
  PetscFunctionReturn(0);
}

PetscErrorCode ViscoelasticAddChecksum(const Viscoelastic *law, Checksum c)
{
  PetscFunctionBeginUser;
  if (!law->kind) PetscFunctionReturn(0);
  PetscCall(ChecksumAddInts(c, 1, (const PetscInt[]){law->kind}));
  PetscCall(ChecksumAddReals(c, law->n, law->value));
  for (PetscInt t = 0; t < law->n_tables; t++)
    for (PetscInt i = 0; i < law->table[t].n_rows; i++) {
      const ViscoelasticRow *row = &law->table[t].row[i];

      PetscCall(ChecksumAddReals(
        c, 4, (const PetscReal[]){row->x, creal(row->modulus), cimag(row->modulus), law->table[t].temperature}));
    }
  PetscFunctionReturn(0);
}

PetscErrorCode ViscoelasticFree(Viscoelastic *law)
{
  ViscoelasticTable *table = (ViscoelasticTable *)law->table;

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < law->n_tables; t++) PetscCall(PetscFree(table[t].row));
  PetscCall(PetscFree(table));
  law->table    = NULL;
  law->n_tables = 0;
  PetscFunctionReturn(0);
}
