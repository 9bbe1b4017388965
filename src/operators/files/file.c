/*
   Matrices without a mesh: PETSc binary files (MatLoad) or dense lists in the options, rows one after another. Each is
   one term, H with the coefficient contact_mu; matrixterm.c has those of the list -terms. K, M and C count as terms
   that are there without friction, symmetric or not.
*/
#include "base/file.h"
#include "matrixterm.h"
#include "operators/superelement/superelement.h"
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const letters[N_OPERATORS] = {"k", "m", "c", "h"};
PetscErrorCode           OperatorsLoadFromOptions(Operators o)
{
  PetscFunctionBeginUser;
  PetscCall(QuantitiesRead(o->comm, &operators_matrices, o));
  for (int i = 0; i < N_OPERATORS; i++)
    PetscCheck(!o->n_dense[i] || !o->load[i][0], o->comm, PETSC_ERR_USER_INPUT,
               "-operators_load_%s and -operators_dense_%s exclude each other", letters[i], letters[i]);
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddChecksum(Operators o, Checksum c)
{
  PetscFunctionBeginUser;
  PetscCall(ChecksumSetPart(c, "matrices"));
  PetscCall(ChecksumAddInts(c, 1, (const PetscInt[]){o->lump}));
  PetscCall(SuperelementsAddChecksum(o, c));
  if (o->model) PetscFunctionReturn(0);
  PetscCall(ChecksumAddReals(c, 1, &o->loaded_mu));
  PetscCall(MatrixTermsAddChecksum(o, c));
  for (PetscInt t = 0; t < o->terms.n; t++) PetscCall(MatrixAddChecksum(o->terms.term[t].A, c));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsAddSceneChecksum(Operators o, PetscBool with_partition, Checksum c)
{
  PetscFunctionBeginUser;
  if (o->model) PetscCall(ModelAddChecksum(o->model, with_partition, c));
  if (o->contact) PetscCall(ContactAddChecksum(o->contact, c));
  PetscCall(OperatorsAddChecksum(o, c));
  PetscFunctionReturn(0);
}

/* Adds the terms and the parameter */
static PetscErrorCode OperatorsAddMatrices(Operators o, Mat A[N_OPERATORS])
{
  static const OperatorsTermKind kind[] = {OPERATORS_STIFFNESS, OPERATORS_MASS, OPERATORS_DAMPING};
  PetscInt                       mu;

  PetscFunctionBeginUser;
  for (int i = OPERATOR_K; i <= OPERATOR_C; i++)
    if (A[i]) {
      PetscCall(TermsAdd(&o->terms, kind[i], A[i], PETSC_TRUE, 0, NULL));
      PetscCall(TermsSetCause(&o->terms, o->terms.term[o->terms.n - 1].cause_kind, "operators", letters[i]));
    }
  if (!A[OPERATOR_H]) PetscFunctionReturn(0);
  mu = ParametersFind(&o->parameters, "contact_mu");
  if (mu < 0) {
    PetscCall(ParametersAdd(&o->parameters, "contact", "mu",
                            &(OperatorsParameter){.row = operators_loaded.row, .value = o->loaded_mu}, &mu));
    o->mu = mu;
  }
  PetscCall(TermsAdd(&o->terms, OPERATORS_STIFFNESS, A[OPERATOR_H], PETSC_FALSE, 1, &mu));
  PetscCall(TermsSetCause(&o->terms, "friction", NULL, "contact"));
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsSetMatrices(Operators o, Mat K, Mat M)
{
  PetscFunctionBeginUser;
  PetscCall(OperatorsAddMatrices(o, (Mat[N_OPERATORS]){[OPERATOR_K] = K, [OPERATOR_M] = M}));
  PetscFunctionReturn(0);
}

/* Raises an error for matrices that do not fit each other */
static PetscErrorCode OperatorsCheckMatrices(Operators o, Mat A[N_OPERATORS])
{
  PetscInt n = -1, rows, columns, first = 0;

  PetscFunctionBeginUser;
  for (int i = OPERATOR_K; i <= OPERATOR_M && !o->n_named; i++)
    PetscCheck(A[i], o->comm, PETSC_ERR_USER_INPUT,
               "-operators_load_%s or -operators_dense_%s is missing: K and M are both needed", letters[i], letters[i]);
  for (int i = 0; i < N_OPERATORS; i++) {
    if (!A[i]) continue;
    PetscCall(MatGetSize(A[i], &rows, &columns));
    if (n < 0) n = rows, first = i;
    PetscCheck(rows == n && columns == n, o->comm, PETSC_ERR_USER_INPUT,
               "matrix %s is %" PetscInt_FMT " x %" PetscInt_FMT ", but %c has %" PetscInt_FMT
               " rows: all must be square and alike",
               letters[i], rows, columns, "KMCH"[first], n);
  }
  PetscCheck(A[OPERATOR_H] || o->loaded_mu == 0 || ParametersFind(&o->parameters, "contact_mu") >= 0, o->comm,
             PETSC_ERR_USER_INPUT, "-contact_mu %.6g does nothing without -operators_load_h or -operators_dense_h",
             (double)o->loaded_mu);
  PetscFunctionReturn(0);
}

/* One of the four, from its file or its list; NULL where neither is given */
static PetscErrorCode OperatorsReadMatrix(Operators o, int i, Mat *A)
{
  char option[64];

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(option, sizeof(option), "-operators_%s_%s", o->load[i][0] ? "load" : "dense", letters[i]));
  if (o->load[i][0])
    PetscCall(MatrixReadFile(o->comm, option, o->load[i], A));
  else if (o->n_dense[i])
    PetscCall(MatrixReadDense(o->comm, option, o->n_dense[i], o->dense[i], A));
  PetscFunctionReturn(0);
}

/* Symmetry is looked at where all three of K, M and C are there; one that is not makes all terms unsymmetric. */
PetscErrorCode OperatorsLoad(Operators o)
{
  Mat A[N_OPERATORS] = {NULL};

  PetscFunctionBeginUser;
  for (int i = 0; i < N_OPERATORS; i++) PetscCall(OperatorsReadMatrix(o, i, &A[i]));
  PetscCall(OperatorsCheckMatrices(o, A));
  if (!o->n_named) PetscCall(MassCheck(A[OPERATOR_M], "", &o->mass_singular));
  for (int i = OPERATOR_K; i <= OPERATOR_C && o->symmetric; i++)
    if (A[i]) PetscCall(MatrixIsSymmetric(A[i], &o->symmetric));
  PetscCall(OperatorsAddMatrices(o, A));
  if (o->n_named) PetscCall(MatrixTermsAdd(o));
  for (PetscInt t = 0; t < o->terms.n && !o->symmetric; t++) o->terms.term[t].symmetric = PETSC_FALSE;
  for (int i = 0; i < N_OPERATORS; i++) PetscCall(MatDestroy(&A[i]));
  PetscFunctionReturn(0);
}

/* Writes one matrix or vector under a temporary name, then renames it: a reader sees the old file or the whole new
   one. PETSc's error handler is silenced, since a full disk is said here in one line; the reason is that of errno. */
static PetscErrorCode PencilSaveObject(Operators o, const char name[], PetscObject A)
{
  char           file[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN];
  PetscViewer    viewer;
  PetscMPIInt    rank;
  PetscErrorCode error;
  int            failed = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s/%s.bin", o->save, name));
  PetscCall(PetscSNPrintf(part, sizeof(part), "%s.part", file));
  PetscCallMPI(MPI_Comm_rank(o->comm, &rank));
  if (rank == 0) failed = FileMake(part);
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, o->comm));
  PetscCheck(!failed, o->comm, PETSC_ERR_FILE_WRITE, "cannot write '%s' of -operators_save: %s", part,
             FileReason(failed));
  PetscCall(MatrixViewerOpen(o->comm, part, FILE_MODE_WRITE, &viewer));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  errno = 0;
  error = PetscObjectView(A, viewer);
  if (!error) error = PetscViewerDestroy(&viewer); /* some disks tell only here that they are full */
  failed = errno;
  PetscCall(PetscPopErrorHandler());
  if (error) (void)unlink(part);
  PetscCheck(!error, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "cannot write '%s' of -operators_save: %s", file,
             strerror(failed));
  failed = rank == 0 && rename(part, file) ? errno : 0;
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, o->comm));
  PetscCheck(!failed, o->comm, PETSC_ERR_FILE_WRITE, "cannot write '%s' of -operators_save: %s", file,
             strerror(failed));
  PetscFunctionReturn(0);
}

/* An earlier run's file of what this one does not have */
static PetscErrorCode PencilRemoveObject(const Operators o, const char name[])
{
  char        file[PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s/%s.bin", o->save, name));
  PetscCallMPI(MPI_Comm_rank(o->comm, &rank));
  if (rank == 0) (void)unlink(file); /* mostly there is none */
  PetscFunctionReturn(0);
}

/* The folder is this run's until it ends: matrices of two runs make no system */
static PetscErrorCode PencilSaveBegin(Operators o)
{
  PetscMPIInt rank;
  int         failed = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(o->comm, &rank));
  if (rank == 0 && o->save_lock <= 0) {
    o->save_lock = FolderLock(o->save);
    failed       = o->save_lock < 0 ? errno : 0;
  }
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, o->comm));
  PetscCheck(!failed, o->comm, PETSC_ERR_FILE_OPEN,
             "another run writes into the folder -operators_save %s; choose another, or wait for its end", o->save);
  PetscFunctionReturn(0);
}

/* Without constraints K, M, C and H as they are told apart; with them the matrices of the pencil, in q. Files of an
   earlier run that this one has not are removed, so that the folder is one system. */
PetscErrorCode PencilSave(Pencil pencil)
{
  Operators      o = pencil->operators;
  PencilMatrices m;
  PencilParts    parts = {.K = NULL};
  PetscMPIInt    rank;
  int            failed = 0;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(o->comm, &rank));
  if (rank == 0 && mkdir(o->save, 0777) && errno != EEXIST) failed = errno;
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, o->comm));
  PetscCheck(!failed, o->comm, PETSC_ERR_FILE_OPEN, "cannot make the folder '%s' of -operators_save: %s", o->save,
             strerror(failed));
  PetscCall(PencilSaveBegin(o));
  PetscCall(PencilGetMatrices(pencil, &m));
  if (!pencil->Zr || !o->model)
    PetscCall(PencilGetParts(pencil, &parts));
  else
    parts = (PencilParts){.K = m.K, .M = m.M, .C = m.C};
  PetscCall(PencilSaveObject(o, "K", (PetscObject)parts.K));
  PetscCall(PencilSaveObject(o, "M", (PetscObject)parts.M));
  if (parts.C)
    PetscCall(PencilSaveObject(o, "C", (PetscObject)parts.C));
  else
    PetscCall(PencilRemoveObject(o, "C"));
  if (parts.H)
    PetscCall(PencilSaveObject(o, "H", (PetscObject)parts.H));
  else
    PetscCall(PencilRemoveObject(o, "H"));
  PetscCall(PencilRemoveObject(o, "F"));
  PetscFunctionReturn(0);
}

PetscErrorCode PencilSaveLoad(Pencil pencil, Vec f)
{
  PencilMatrices m;
  Vec            g;

  PetscFunctionBeginUser;
  PetscCall(PencilGetMatrices(pencil, &m));
  PetscCall(MatCreateVecs(m.K, NULL, &g));
  PetscCall(PencilProjectForce(pencil, PETSC_FALSE, f, g));
  PetscCall(PencilSaveObject(pencil->operators, "F", (PetscObject)g));
  PetscCall(VecDestroy(&g));
  PetscFunctionReturn(0);
}
