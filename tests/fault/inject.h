/* Shared by the files of the library that tests load before the program's own: see inject.c */
#pragma once

#include <stdint.h>
#include <sys/types.h>

/* Kinds of calls that may fail, a bit each */
enum {
  FAULT_OPEN   = 1,
  FAULT_WRITE  = 2,
  FAULT_SYNC   = 4,
  FAULT_RENAME = 8,
  FAULT_CLOSE  = 16,
  FAULT_OWN    = 32, /* allocations that the program asks for */
  FAULT_PETSC  = 64  /* all that go through PETSc */
};

/* Counts a call of that kind, described by the words; whether it is the one to fail, errno being set then */
int FaultTake(int kind, const char words[]);
/* Address of the function that stands behind ours; `function` points to a pointer to it */
void FaultNext(const char name[], void *function);
/* Reads the plan of this process from its environment */
void FaultSetUp(void);
/* Whether the path lies in the folder that is watched */
int FaultPathWatched(const char path[]);
/* streams.c - the system's calls on a file that is watched, each of which may fail */
int     FaultOpen(const char path[], int flags, mode_t mode);
ssize_t FaultWrite(int fd, const void *bytes, size_t size);
int     FaultClose(int fd);
/* memory.c - puts itself between the program and PETSc's allocations */
void FaultMemorySetUp(void);
/* streams.c - opens the open files anew in a copy of this process, whose folder is a copy too, so that places in them are its own */
void FaultFilesCopied(void);
/* branch.c - asks the test at that socket at which call this process is to copy itself; whether the test is there */
int FaultBranchSetUp(const char path[]);
/* Copies this process where call n is that one; whether this is the copy, in which the call is to fail */
int FaultBranch(int64_t n, const char words[]);
