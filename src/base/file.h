/* For rooms that read and write files: opening what may be anything. A pipe would be waited for, a device read without
   an end, a link written through. */
#pragma once

#include <hdf5.h>
#include <petscsys.h>
#include <stdio.h>

/* in errno, beyond those of the system: the name is that of a folder, a pipe, a device, a link */
#define FILE_NO_REGULAR 4096

/* Opens a regular file by open(2)'s flags, to read it or to write into what is there; never waits. Returns -1, and
   errno */
PETSC_INTERN int FileOpen(const char path[], int flags);

/* The same as a stream, by fopen(3)'s mode, which begins with r; NULL, and errno */
PETSC_INTERN FILE *FileStream(const char path[], const char mode[]);

/* Creates an empty file that is nobody else's in place of one of that name; by open(2)'s access, or as a stream by
   fopen(3)'s mode, which begins with w. Refuses what is no regular file, links too. Returns -1 or NULL, and errno */
PETSC_INTERN int   FileCreate(const char path[], int access);
PETSC_INTERN FILE *FileCreateStream(const char path[], const char mode[]);

/* Creates it as FileCreate() does, for libraries that open it by its name; returns errno, 0 when it is there */
PETSC_INTERN int FileMake(const char path[]);

/* A folder of this process alone, which the system takes back however it ends; the descriptor to close. Below 0 where
   there is none: errno is EWOULDBLOCK where another process has it, and 0 where the file system has no locks */
PETSC_INTERN int FolderLock(const char dir[]);

/* How HDF5 opens a file: without a lock, which file systems of clusters may not have. The caller gives it to
   H5Pclose() */
PETSC_INTERN hid_t FileH5Access(void);

/* Opens a regular HDF5 file to read it; negative where that fails */
PETSC_INTERN hid_t FileH5Open(const char path[]);

/* What errno says */
PETSC_INTERN const char *FileReason(int error);
