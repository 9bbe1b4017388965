/*
   A program of one's own on the library: how friction moves the modes of a scene. It builds the scene of its options
   once, K + mu H for each value of -mu_values, and prints the modes of each.

     cc onset.c $(pkg-config --cflags --libs squeal) -o onset
     ./onset -options_file scene.yaml -modes_band 1000,5000 -mu_values 0,0.3,0.6

   The contact of the scene is named `contact`. Prints lines "mu, frequency (Hz), growth (rad/s), label".
*/
#include <squeal/squeal.h>
#include <string.h>

#define MOST_VALUES 16

/* Prints the modes of a pencil */
static PetscErrorCode PrintModes(MPI_Comm comm, Pencil pencil, PetscReal mu)
{
  Modes       modes;
  PetscInt    n;
  const Mode *mode;

  PetscFunctionBeginUser;
  PetscCall(ModesCreate(comm, &modes));
  PetscCall(ModesSetFromOptions(modes));
  PetscCall(ModesSetPencil(modes, pencil));
  PetscCall(ModesSolve(modes));
  PetscCall(ModesGet(modes, &n, &mode));
  for (PetscInt i = 0; i < n; i++)
    PetscCall(PetscPrintf(comm, "%g, %.12g, %.12g, %s\n", (double)mu, (double)(mode[i].omega / (2 * PETSC_PI)),
                          (double)mode[i].sigma, mode[i].label));
  PetscCall(ModesDestroy(&modes));
  PetscFunctionReturn(0);
}

/* The parameter contact_mu takes each value in turn; matrices are assembled once */
static PetscErrorCode Vary(MPI_Comm comm, Operators operators, PetscInt n, const PetscReal mu[])
{
  const OperatorsParameter *parameter;
  PetscInt                  n_parameters, which = 0;
  PetscReal                *p;
  Pencil                    pencil;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(operators, &n_parameters, &parameter));
  while (which < n_parameters && strcmp(parameter[which].name, "contact_mu")) which++;
  PetscCheck(which < n_parameters, comm, PETSC_ERR_USER_INPUT, "the scene has no contact_mu");
  PetscCall(OperatorsCreatePoint(operators, NULL, &p));
  PetscCall(OperatorsLinearise(operators, NULL, &pencil));
  for (PetscInt i = 0; i < n; i++) {
    p[which] = mu[i];
    PetscCall(PencilSetParameters(pencil, p));
    PetscCall(PrintModes(comm, pencil, mu[i]));
  }
  PetscCall(PencilDestroy(&pencil));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(MPI_Comm comm)
{
  PetscReal mu[MOST_VALUES];
  PetscInt  n = MOST_VALUES;
  PetscBool given;
  Model     model;
  Contact   contact;
  Operators operators;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetRealArray(NULL, NULL, "-mu_values", mu, &n, &given));
  PetscCheck(given, comm, PETSC_ERR_USER_INPUT, "-mu_values is missing, e.g. -mu_values 0,0.3");
  PetscCall(ModelCreate(comm, &model));
  PetscCall(ModelSetFromOptions(model));
  PetscCall(ContactCreate(model, &contact));
  PetscCall(ContactSetFromOptions(contact));
  PetscCall(OperatorsCreate(comm, &operators));
  PetscCall(OperatorsSetFromOptions(operators));
  PetscCall(OperatorsSetModel(operators, model, contact));
  PetscCall(ModelSetUp(model));
  PetscCall(ContactSetUp(contact));
  PetscCall(OperatorsSetUp(operators));
  PetscCall(Vary(comm, operators, n, mu));
  PetscCall(OperatorsDestroy(&operators));
  PetscCall(ContactDestroy(&contact));
  PetscCall(ModelDestroy(&model));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  PetscErrorCode error = SquealInitialize(&argc, &argv, "modes of a scene over its friction");

  if (!error) error = Run(PETSC_COMM_WORLD);
  return SquealFinalize(error);
}
