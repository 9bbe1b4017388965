/*
   Results - tables (CSV) and fields (HDF5 with an XDMF file beside it) in one folder. Every file is written under a
   temporary name (the final one and .part) and renamed when it is complete, so that a final name always means a whole
   file.
*/
#pragma once

#include <squeal/quantity.h>
#include <petscsys.h>
#include <squeal/mesh.h>
#include <stdint.h>

typedef struct _p_Results      *Results;
typedef struct _p_ResultsTable *ResultsTable;
typedef struct _p_ResultsField *ResultsField;
typedef struct _p_ResultsFilm  *ResultsFilm;

/*@ ResultsCreate - makes a writer. Collective. @*/
PetscErrorCode ResultsCreate(MPI_Comm comm, Results *results);

/*@
   ResultsSetFromOptions - reads where to write. Collective.

   Options are the rows of src/results/results.c.
@*/
PetscErrorCode ResultsSetFromOptions(Results results);

/*@ ResultsVisit - shows the rows of its options. Collective. @*/
PetscErrorCode ResultsVisit(Results results, const QuantityVisitor *visitor);

/*@ ResultsOpenDirectory - makes the folder and its parents where they are missing, and locks it until ResultsUnlock().
    Collective. Errors: PETSC_ERR_FILE_OPEN with the folder and the reason, also for a folder in which nothing may be
    written, or into which another run writes. @*/
PetscErrorCode ResultsOpenDirectory(Results results);

/*@ ResultsUnlock - lets another run write into the folder, also where this one has failed; ResultsDestroy() does so
   too. Not collective. @*/
void ResultsUnlock(Results results);

/*@ ResultsGetDirectory - the folder (borrowed). Not collective. @*/
PetscErrorCode ResultsGetDirectory(Results results, const char **dir);

/*@ ResultsWantFields - whether fields are to be written. Not collective. @*/
PetscErrorCode ResultsWantFields(Results results, PetscBool *wanted);

/*@ ResultsTableOpen - begins table `name`.csv with its header line. Collective.
    Errors: as ResultsTableClose(). @*/
PetscErrorCode ResultsTableOpen(Results results, const char name[], const char header[], ResultsTable *table);

/*@ ResultsTableRow - one record, printf-like, without the end of the line; %.15g for numbers, text that may hold a
    comma in double quotes. Collective, rank 0 writes. Failures are kept for ResultsTableClose(). @*/
PetscErrorCode ResultsTableRow(ResultsTable table, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);

/*@ ResultsTableNumbers - one record of n numbers. As ResultsTableRow(). @*/
PetscErrorCode ResultsTableNumbers(ResultsTable table, PetscInt n, const PetscReal values[]);

/*@ ResultsTableCheck - raises what has failed so far, for runs too long to learn of it at the end. Rows are written
    in blocks of some kilobytes, and failures show with them. Collective. Errors: as ResultsTableClose(). @*/
PetscErrorCode ResultsTableCheck(ResultsTable table);

/* How far a table has been written: its length, and the checksum of that */
typedef struct {
  PetscInt64 bytes;
  uint64_t   sum;
} ResultsMark;

/*@ ResultsTableFlush - brings all rows to the disk, and gives the mark of the table on every rank, from which
    ResultsTableReopen() goes on; from then on the temporary file is kept whatever fails. Collective.
    Errors: as ResultsTableClose(). @*/
PetscErrorCode ResultsTableFlush(ResultsTable table, ResultsMark *mark);

/*@ ResultsTableReopen - goes on with table `name` of a run that was killed: cuts its temporary file, or where there
    is none the complete one, back to the mark. Collective.
    Errors: PETSC_ERR_FILE_UNEXPECTED for a file that is missing, shorter, has another header, or other rows before the
    mark. @*/
PetscErrorCode ResultsTableReopen(Results results, const char name[], const char header[], const ResultsMark *mark,
                                  ResultsTable *table);

/*@ ResultsTableSuspend - closes the table under its temporary name, for ResultsTableReopen(). Collective; the handle is
    freed in any case. Errors: as ResultsTableClose(). @*/
PetscErrorCode ResultsTableSuspend(ResultsTable *table);

/*@ ResultsTableClose - completes the table under its final name. Collective; the handle is freed in any case.
    Errors: PETSC_ERR_FILE_WRITE with the file and the reason, e.g. no space left on device; the temporary file is
    removed. @*/
PetscErrorCode ResultsTableClose(ResultsTable *table);

/*@
   ResultsFieldOpen - begins `name`.h5 and `name`.xmf with the mesh (borrowed until the end). Collective.

   The HDF5 file is also a VTKHDF unstructured grid, which VTK's own reader opens; nodes and cells are ordered by rank.

   Errors: PETSC_ERR_ARG_NULL without a mesh, PETSC_ERR_FILE_WRITE
   as for tables: neither file is then left, under its temporary or its final name.
@*/
PetscErrorCode ResultsFieldOpen(Results results, const char name[], const Mesh *mesh, ResultsField *field);

/* Values at the nodes: shape [local nodes][width], width 1 or 3 */
typedef struct {
  const char      *key; /* name of the array, with its unit: displacement_m */
  PetscInt         width;
  const PetscReal *values; /* [local nodes][width], in the unit of the name */
} ResultsNodal;

/*@
   ResultsFieldWriteMode - one complex shape: arrays `<key>_re` and `<key>_im` (m) at all nodes, zero where a support
   fixes them. Collective.

   Input Parameters:
+  key    - short unique name: mode_007 for the mode that modes.csv lists as 7
.  title  - a line for people, e.g. "7: 3458.21 Hz, growth 298 1/s, (0,4+)"
.  re, im - shape [local nodes][3]
-  more   - a further array of the mode, `<key>_<more key>`, or NULL
@*/
PetscErrorCode ResultsFieldWriteMode(ResultsField field, const char key[], const char title[], const PetscReal re[],
                                     const PetscReal im[], const ResultsNodal *more);

/*@ ResultsFieldWriteNodal - one real state of the body: n arrays under one title, which ParaView shows as one grid.
    Collective. @*/
PetscErrorCode ResultsFieldWriteNodal(ResultsField field, const char title[], PetscInt n, const ResultsNodal arrays[]);

/*@ ResultsFieldClose - completes both files under their final names. Collective; the handle is freed in any case.
    Errors: as ResultsFieldOpen(). @*/
PetscErrorCode ResultsFieldClose(ResultsField *field);

/*@
   ResultsFilmCreate - states of one mesh in time: each is a field of its own, `frame`_000000 and so on, and
   `name`.xmf shows those that there are in time. The mesh is borrowed. Collective.
@*/
PetscErrorCode ResultsFilmCreate(Results results, const char name[], const char frame[], const Mesh *mesh,
                                 ResultsFilm *film);

/*@ ResultsFilmSetTimes - times (s) of the n frames that an earlier run has written, after which this one goes on. Not
    collective, same call on all ranks. @*/
PetscErrorCode ResultsFilmSetTimes(ResultsFilm film, PetscInt n, const PetscReal times[]);

/*@ ResultsFilmGetTimes - times of the frames so far, s (borrowed until the next frame). Not collective. @*/
PetscErrorCode ResultsFilmGetTimes(ResultsFilm film, PetscInt *n, const PetscReal **times);

/*@ ResultsFilmWrite - the next frame, and `name`.xmf anew; arrays of the same keys every time. Collective.
    Errors: as ResultsFieldOpen(). @*/
PetscErrorCode ResultsFilmWrite(ResultsFilm film, PetscReal time, const char title[], PetscInt n,
                                const ResultsNodal arrays[]);

/*@ ResultsFilmDestroy - frees it; all files stay. Collective. @*/
PetscErrorCode ResultsFilmDestroy(ResultsFilm *film);

/* Bytes that one rank adds to a file */
typedef struct {
  const void *bytes;
  size_t      size;
} ResultsPiece;

/*@
   ResultsBinaryWrite - file `name` of the pieces of all ranks of a communicator one after the other, those of rank 0
   first. They are on the disk, under the final name, when it returns; until then a file of that name stays as it is.
   scene.yaml names the file where it is `listed`. Collective on the communicator, which is that of the results, or of
   one rank and not listed. Errors: PETSC_ERR_FILE_WRITE with the file and the reason; the temporary file is removed.
@*/
PetscErrorCode ResultsBinaryWrite(Results results, MPI_Comm comm, const char name[], PetscBool listed, PetscInt n,
                                  const ResultsPiece pieces[]);

/*@ ResultsKeep - the file `name` in the folder belongs to this run; those that it writes do so anyway. Collective. @*/
PetscErrorCode ResultsKeep(Results results, const char name[]);

/*@ ResultsKeepFolder - this run reads the results of an earlier one in `folder`: where that is the folder of its own,
    all files stay. Collective. @*/
PetscErrorCode ResultsKeepFolder(Results results, const char folder[]);

/*@
   ResultsKeepScene - begins the account of the run: its time, and all options of squeal in force. Collective; before
   anything is written. From then on scene.yaml names each file before it has its final name.

   Input Parameters:
+  show - shows the rows of all rooms, with their values
-  ctx  - its context
@*/
PetscErrorCode ResultsKeepScene(Results results, QuantityShow show, void *ctx);

/*@ ResultsBegin - writes scene.yaml, with `end: not yet`, where the folder has none, or in place of an earlier run's
   with
    `replace`: for runs that keep something before they write a table. Once it is there, nothing is done. Collective.
    @*/
PetscErrorCode ResultsBegin(Results results, PetscBool replace);

/*@
   ResultsNote - a line "# key: text" of scene.yaml, what a run says of its errors. Collective; before ResultsFinish().

   Input Parameters:
+  key    - letters, digits and -, once in a run
-  format - printf-like, with the values, one line
@*/
PetscErrorCode ResultsNote(Results results, const char key[], const char format[], ...) PETSC_ATTRIBUTE_FORMAT(3, 4);

/*@
   ResultsFinish - ends a run that did what was asked. Collective.

   It writes scene.yaml anew: the commands of this run and of its repetition, versions, ranks, time, memory, both of
   each stage too, what ResultsNote() was told, the files, and all options in force, as a file that -options_file reads.
   Then the files go that the scene.yaml of an earlier run in the folder lists. All others stay, and so does what a
   killed run goes on from: a transient while its table is unfinished, sweep_restart_*. Errors: as ResultsTableClose().
@*/
PetscErrorCode ResultsFinish(Results results);

/*@ ResultsDestroy - frees the writer. Collective. @*/
PetscErrorCode ResultsDestroy(Results *results);
