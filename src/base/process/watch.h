/* Who says that a rank was killed */
#pragma once

/* Leaves a parent behind where a launcher runs several ranks; before MPI_Init() */
void WatchBegin(void);

/* Where results are from now on, for that line */
void WatchFolder(const char folder[]);
