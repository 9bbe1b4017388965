/* For rooms that write files: folders that are written into */
#pragma once

#include <petscsys.h>

/* Makes the folder and its parents where they are missing; returns errno, 0 when one is there that may be written
   into */
PETSC_INTERN int PathMakeFolders(const char dir[]);

/* Deletes the files of a folder of which the names begin so; what cannot be deleted stays. Not collective: one rank
   calls */
PETSC_INTERN void PathForget(const char dir[], const char begin[]);
