/*
   Results - tables (CSV) and fields (HDF5 with an XDMF file beside it) in one folder. Every file is written under a
   temporary name and renamed when it is complete, so that a final name always means a whole file.
*/
#pragma once

#include <petscdmplex.h>

typedef struct _p_Results      *Results;
typedef struct _p_ResultsTable *ResultsTable;
typedef struct _p_ResultsField *ResultsField;

/*@ ResultsCreate - makes a writer. Collective. @*/
PetscErrorCode ResultsCreate(MPI_Comm comm, Results *results);

/*@
   ResultsSetFromOptions - reads where to write. Collective.

   Options Database Keys:
+  -output_dir <results>  - folder of all files
-  -output_fields <true>  - write shapes (*.h5, *.xmf) beside the tables
@*/
PetscErrorCode ResultsSetFromOptions(Results results);

/*@ ResultsOpenDirectory - makes the folder and its parents where they are missing. Collective.
    Errors: PETSC_ERR_FILE_OPEN with the folder and the reason, also for a folder in which nothing may be written. @*/
PetscErrorCode ResultsOpenDirectory(Results results);

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

/*@ ResultsTableClose - completes the table under its final name. Collective; the handle is freed in any case.
    Errors: PETSC_ERR_FILE_WRITE with the file and the reason, e.g. no space left on device; the temporary file is
    removed. @*/
PetscErrorCode ResultsTableClose(ResultsTable *table);

/*@
   ResultsFieldOpen - begins `name`.h5 and `name`.xmf with the mesh. Collective.

   Input Parameters:
+  dm        - mesh with three displacements per vertex
.  n_parts   - number of parts
.  parts     - their names
-  cell_part - part of each local cell

   The HDF5 file is also a VTKHDF unstructured grid, which VTK's own reader opens; nodes and cells are ordered by rank.

   Errors: PETSC_ERR_ARG_NULL without a mesh, PETSC_ERR_SUP for cells other than hexahedra, PETSC_ERR_FILE_WRITE
   as for tables: neither file is then left, under its temporary or its final name.
@*/
PetscErrorCode ResultsFieldOpen(Results results, const char name[], DM dm, PetscInt n_parts, const char *const parts[],
                                const PetscInt cell_part[], ResultsField *field);

/*@
   ResultsFieldWriteMode - one complex shape: arrays `<key>_re` and `<key>_im` (m) at all nodes, zero where a support
   fixes them. Collective.

   Input Parameters:
+  key    - short unique name: mode_007 for the mode that modes.csv lists as 7
.  title  - a line for people, e.g. "7: 3458.21 Hz, growth 298 1/s, (0,4+)"
-  re, im - global vectors of the DM; im may be NULL (then zero)
@*/
PetscErrorCode ResultsFieldWriteMode(ResultsField field, const char key[], const char title[], Vec re, Vec im);

/* Values at the nodes: shape [local vertices of the DM][width], width 1 or 3 */
typedef struct {
  const char      *key; /* name of the array, with its unit: displacement_m */
  PetscInt         width;
  const PetscReal *values;
} ResultsNodal;

/*@ ResultsFieldWriteNodal - one real state of the body: n arrays under one title, which ParaView shows as one grid.
    Collective. @*/
PetscErrorCode ResultsFieldWriteNodal(ResultsField field, const char title[], PetscInt n, const ResultsNodal arrays[]);

/*@ ResultsFieldClose - completes both files under their final names. Collective; the handle is freed in any case.
    Errors: as ResultsFieldOpen(). @*/
PetscErrorCode ResultsFieldClose(ResultsField *field);

/*@ ResultsDestroy - frees the writer. Collective. @*/
PetscErrorCode ResultsDestroy(Results *results);
