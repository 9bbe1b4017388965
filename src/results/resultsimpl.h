/*
   Private to results/: a file under its temporary name, text, HDF5 or binary, and the XDMF text that describes the
   fields.

   Errors of the system are noted per rank (errno) while writing, and raised on all ranks by OutFilesCheck() and
   OutFilesPublish(). HDF5 is driven by the first rank alone, with its serial driver, for groups, attributes and the
   layout of the datasets; all ranks then write their rows in place. MPI-IO is not used: the collective writes of
   Open MPI 4.1 report success, or never return, when the disk is full.
*/
#pragma once

#include <squeal/checksum.h>
#include <squeal/results.h>
#include <hdf5.h>
#include <stdio.h>

/* scene.yaml, and its lines that name the files of a run, and those of earlier runs that stay */
#define SCENE       "scene"
#define SCENE_FILES "# files:"
#define SCENE_STAY  "# files of earlier runs:"

#define OUTFILE_NO_MEMORY 4097 /* in errno: there is no file in memory */

struct _p_Results {
  MPI_Comm      comm;
  char          dir[PETSC_MAX_PATH_LEN];
  PetscBool     fields, overwrite;
  PetscInt      n_kept, n_earlier, n_notes;
  char        **kept;         /* names of files in the folder that belong to this run */
  char        **earlier;      /* those that earlier runs wrote and this one does not keep, on the first rank */
  char        **note;         /* lines of scene.yaml */
  PetscBool     keep_all;     /* nothing of earlier runs goes */
  PetscBool     has_earlier;  /* the folder had a scene.yaml of an earlier run, alike on all ranks */
  PetscBool     has_finished; /* and a result of it under its final name, likewise */
  PetscInt      n_listed;     /* files that scene.yaml of this run names, 0 before it is there */
  QuantityTexts options;      /* all, as the run found them */
  double        begun;        /* MPI_Wtime() */
  int           lock;         /* of the folder, on the first rank, else -1 */
};

/* A file that is being written as `part`, to be renamed to `name` */
typedef struct {
  MPI_Comm   comm;
  Results    results; /* borrowed */
  char       name[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN];
  PetscBool  keep;   /* a failure leaves `part`, since a run may go on from what is in it */
  int        error;  /* errno of the first failure on this rank; 0 = none */
  FILE      *stream; /* text: open on the first rank */
  uint64_t   sum;    /* text: checksum of its first `summed` bytes, whole blocks */
  PetscInt64 summed;
  hid_t      h5;     /* HDF5: open on the first rank, else H5I_INVALID_HID */
  int        memory; /* HDF5: what the library writes, on the first rank, else -1 */
  PetscInt   n_rows; /* HDF5: bytes of the file that are rows, in order */
  struct {
    uint64_t offset, size;
  } * rows;
  int fd; /* HDF5, binary: for the rows or pieces of this rank, else -1 */
} OutFile;

/* Rows of a distributed table of values that this rank holds: [first, first + n_local) of n_global */
typedef struct {
  PetscInt first, n_local, n_global;
} ResultsRows;

/* XDMF text: grids on one mesh, whose values are in HDF5 files beside it */
typedef struct {
  OutFile        file;
  char           h5_name[PETSC_MAX_PATH_LEN];      /* of the next grid: relative to the folder of the text */
  const Element *element;                          /* of all cells; NULL where there are several */
  PetscInt       n_nodes, n_cells, n_ids, n_grids; /* n_ids: nodes of all cells together */
} Xdmf;

struct _p_ResultsField {
  const Mesh *mesh; /* borrowed */
  OutFile     h5;
  Xdmf        xdmf;
  ResultsRows nodes, cells, ids; /* ids: nodes of the cells */
  PetscBool   timed;             /* grids stand at `time`, else at their number */
  PetscReal   time;              /* s */
};

/* outfile.c */
PETSC_INTERN PetscErrorCode OutFileSetName(Results results, const char name[], const char extension[], OutFile *file);
PETSC_INTERN PetscErrorCode OutFileSetPath(Results results, MPI_Comm comm, const char name[], const char extension[],
                                           OutFile *file);
PETSC_INTERN PetscErrorCode OutFileNote(OutFile *file, PetscBool failed);
PETSC_INTERN PetscErrorCode OutFileOpenText(OutFile *file);
PETSC_INTERN PetscErrorCode OutFileReopenText(OutFile *file, const char head[], const ResultsMark *mark);
PETSC_INTERN PetscErrorCode OutFileFlushText(OutFile *file, ResultsMark *mark);
PETSC_INTERN PetscErrorCode OutFileCloseText(OutFile *file);
PETSC_INTERN PetscErrorCode OutFilePrint(OutFile *file, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
PETSC_INTERN PetscErrorCode OutFileVPrint(OutFile *file, const char format[], va_list values);
PETSC_INTERN PetscErrorCode OutFileWriteAt(OutFile *file, const char *bytes, size_t size, off_t offset);
PETSC_INTERN PetscErrorCode OutFilesCheck(PetscInt n, OutFile *const files[]);
PETSC_INTERN PetscErrorCode OutFilesPublish(PetscInt n, OutFile *const files[]);

/* lock.c */
PETSC_INTERN PetscErrorCode ResultsLock(Results results);

/* earlier.c */
PETSC_INTERN PetscErrorCode EarlierRead(Results results);
PETSC_INTERN PetscErrorCode EarlierPrint(Results results, PetscBool ended, OutFile *file);
PETSC_INTERN PetscErrorCode EarlierRemove(Results results);

/* provenance.c */
PETSC_INTERN PetscErrorCode ResultsListFiles(Results results);
PETSC_INTERN PetscErrorCode ResultsForget(Results results);

/* h5file.c */
PETSC_INTERN PetscErrorCode OutFileOpenH5(OutFile *file);
PETSC_INTERN PetscErrorCode OutFileH5Group(OutFile *file, const char path[]);
PETSC_INTERN PetscErrorCode OutFileH5Write(OutFile *file, const char path[], hid_t type, const ResultsRows *rows,
                                           PetscInt width, const void *values);
PETSC_INTERN PetscErrorCode OutFileH5Integers(OutFile *file, const char path[], const char attribute[], PetscInt n,
                                              const int values[]);
PETSC_INTERN PetscErrorCode OutFileH5Strings(OutFile *file, const char path[], const char attribute[], PetscInt n,
                                             const char *const strings[]);
PETSC_INTERN PetscErrorCode OutFileH5Close(OutFile *file);

/* xdmf.c */
PETSC_INTERN PetscErrorCode XdmfBegin(Xdmf *xdmf, PetscInt n_parts, const char *const parts[]);
PETSC_INTERN PetscErrorCode XdmfGridBegin(Xdmf *xdmf, const char name[], const char title[], const PetscReal *time);
PETSC_INTERN PetscErrorCode XdmfNodal(Xdmf *xdmf, const char name[], const char key[], const char suffix[],
                                      PetscInt width);
PETSC_INTERN PetscErrorCode XdmfGridEnd(Xdmf *xdmf);
PETSC_INTERN PetscErrorCode XdmfEnd(Xdmf *xdmf);
