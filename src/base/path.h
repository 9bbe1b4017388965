/* For base/ and results/: folders that are written into */
#pragma once

#include <petscsys.h>

/* Makes the folder and its parents where they are missing; returns errno, 0 when one is there that may be written into */
PETSC_INTERN int PathMakeFolders(const char dir[]);
