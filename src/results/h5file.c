/*
   HDF5 files written by all ranks. The first rank creates groups, attributes and datasets; a dataset is contiguous and
   allocated at once, so that row r of width w lies at byte offset + r w size, where each rank writes its own rows.
   HDF5 crashes at its end when it could not write or close a file. Hence it is given a file in memory, which holds
   nothing where the rows are; all the rest is copied from there when HDF5 has closed it.
   Reference: The HDF Group, HDF5 Reference Manual, H5Dget_offset, H5Pset_alloc_time.
*/
#define _GNU_SOURCE /* memfd_create() */
#include "resultsimpl.h"
#include "base/file.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#define H5_BLOCK 65536 /* bytes copied at a time */
#define H5_ROOM  65536 /* bytes for what HDF5 adds between two datasets */

/* Evaluates an HDF5 call that returns a negative value on failure; reasons are reported by us, hence silence here */
#define H5Quietly(result, call)                                                                                        \
  do {                                                                                                                 \
    H5E_BEGIN_TRY                                                                                                      \
    {                                                                                                                  \
      errno  = 0;                                                                                                      \
      result = (call);                                                                                                 \
    }                                                                                                                  \
    H5E_END_TRY;                                                                                                       \
  } while (0)

/* Notes the failure of an HDF5 call */
static PetscErrorCode OutFileH5Note(OutFile *file, PetscInt64 result)
{
  PetscFunctionBeginUser;
  PetscCall(OutFileNote(file, result < 0 ? PETSC_TRUE : PETSC_FALSE));
  PetscFunctionReturn(0);
}

/* Whether a file may have `size` more bytes, and some: `ulimit -f` holds in memory, too */
static PetscErrorCode OutFileH5Room(OutFile *file, hsize_t size)
{
  struct rlimit limit;
  hsize_t       used = 0;
  herr_t        result;

  PetscFunctionBeginUser;
  if (getrlimit(RLIMIT_FSIZE, &limit) || limit.rlim_cur == RLIM_INFINITY) PetscFunctionReturn(0);
  if (file->h5 >= 0) {
    H5Quietly(result, H5Fget_filesize(file->h5, &used));
    PetscCall(OutFileH5Note(file, result));
  }
  errno = EFBIG;
  PetscCall(OutFileNote(file, used + size + H5_ROOM > limit.rlim_cur ? PETSC_TRUE : PETSC_FALSE));
  PetscFunctionReturn(0);
}

/* A file in memory, which no file system bounds: /dev/shm may be full or read-only. Its failure is one of its own */
static PetscErrorCode OutFileCreateMemory(OutFile *file)
{
  PetscFunctionBeginUser;
  file->memory = memfd_create("squeal", MFD_CLOEXEC);
  if (file->memory < 0 && !file->error) file->error = OUTFILE_NO_MEMORY;
  PetscFunctionReturn(0);
}

/* Puts the file in memory below HDF5, with what it has written already */
static PetscErrorCode OutFileH5Detach(OutFile *file)
{
  const off_t end   = lseek(file->fd, 0, SEEK_END);
  char       *block = NULL;
  void       *below = NULL; /* of the driver that HDF5 has by default: its descriptor */
  herr_t      result;

  PetscFunctionBeginUser;
  PetscCall(OutFileNote(file, end < 0 || end > H5_BLOCK ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(PetscCalloc1(H5_BLOCK, &block));
  if (!file->error)
    PetscCall(OutFileNote(file, pread(file->fd, block, (size_t)end, 0) != end ||
                                  pwrite(file->memory, block, (size_t)end, 0) != end));
  PetscCall(PetscFree(block));
  H5Quietly(result, H5Fget_vfd_handle(file->h5, H5P_DEFAULT, &below));
  PetscCall(OutFileH5Note(file, result));
  if (below) PetscCall(OutFileNote(file, dup2(file->memory, *(int *)below) < 0 ? PETSC_TRUE : PETSC_FALSE));
  PetscFunctionReturn(0);
}

/* Creates the file on the first rank, which HDF5 then leaves alone */
static PetscErrorCode OutFileCreateH5(OutFile *file)
{
  hid_t access;

  PetscFunctionBeginUser;
  file->fd = FileCreate(file->part, O_RDWR);
  PetscCall(OutFileNote(file, file->fd < 0 ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(OutFileH5Room(file, 0));
  PetscCall(OutFileCreateMemory(file));
  if (file->error) PetscFunctionReturn(0);
  access = FileH5Access();
  H5Quietly(file->h5, H5Fcreate(file->part, H5F_ACC_TRUNC, H5P_DEFAULT, access));
  PetscCall(OutFileH5Note(file, file->h5));
  (void)H5Pclose(access);
  if (file->h5 >= 0) PetscCall(OutFileH5Detach(file));
  PetscFunctionReturn(0);
}

/* Creates the file and opens it on all ranks; collective, raises its failures */
PetscErrorCode OutFileOpenH5(OutFile *file)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(file->comm, &rank));
  if (rank == 0) PetscCall(OutFileCreateH5(file));
  PetscCall(OutFilesCheck(1, &file));
  if (rank > 0) {
    file->fd = FileOpen(file->part, O_WRONLY);
    PetscCall(OutFileNote(file, file->fd < 0 ? PETSC_TRUE : PETSC_FALSE));
  }
  PetscCall(OutFilesCheck(1, &file));
  PetscFunctionReturn(0);
}

/* Creates a group */
PetscErrorCode OutFileH5Group(OutFile *file, const char path[])
{
  hid_t  group;
  herr_t closed;

  PetscFunctionBeginUser;
  if (file->h5 < 0 || file->error) PetscFunctionReturn(0);
  H5Quietly(group, H5Gcreate2(file->h5, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Quietly(closed, H5Gclose(group));
  PetscCall(OutFileH5Note(file, closed));
  PetscFunctionReturn(0);
}

/* Creates a dataset of dims[n_dims] values on the first rank and says where in the file its values begin */
static PetscErrorCode OutFileH5Dataset(OutFile *file, const char path[], hid_t type, int n_dims, const hsize_t dims[],
                                       uint64_t *offset)
{
  hid_t   space, plan, dataset;
  haddr_t address;
  herr_t  closed;

  PetscFunctionBeginUser;
  H5Quietly(space, H5Screate_simple(n_dims, dims, NULL));
  H5Quietly(plan, H5Pcreate(H5P_DATASET_CREATE));
  H5Quietly(closed, H5Pset_alloc_time(plan, H5D_ALLOC_TIME_EARLY));
  H5Quietly(closed, H5Pset_fill_time(plan, H5D_FILL_TIME_NEVER));
  H5Quietly(dataset, H5Dcreate2(file->h5, path, type, space, H5P_DEFAULT, plan, H5P_DEFAULT));
  PetscCall(OutFileH5Note(file, dataset));
  H5Quietly(address, H5Dget_offset(dataset));
  H5Quietly(closed, H5Dclose(dataset));
  PetscCall(OutFileH5Note(file, closed));
  H5Quietly(closed, H5Pclose(plan));
  H5Quietly(closed, H5Sclose(space));
  *offset = (uint64_t)address;
  PetscFunctionReturn(0);
}

/* Notes that bytes of the file are rows, in the order of their offsets */
static PetscErrorCode OutFileH5Rows(OutFile *file, uint64_t offset, uint64_t size)
{
  PetscInt i = file->n_rows++;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)file->n_rows * sizeof(*file->rows), &file->rows));
  for (; i > 0 && file->rows[i - 1].offset > offset; i--) file->rows[i] = file->rows[i - 1];
  file->rows[i].offset = offset;
  file->rows[i].size   = size;
  PetscFunctionReturn(0);
}

/*
   Writes a dataset of shape [rows->n_global] (width 1) or [rows->n_global][width]; every rank gives its rows. The type
   is that of the values in memory. Collective; failures are noted.
*/
PetscErrorCode OutFileH5Write(OutFile *file, const char path[], hid_t type, const ResultsRows *rows, PetscInt width,
                              const void *values)
{
  const hsize_t dims[2] = {(hsize_t)rows->n_global, (hsize_t)width};
  const size_t  row     = H5Tget_size(type) * (size_t)width;
  uint64_t      offset  = HADDR_UNDEF;

  PetscFunctionBeginUser;
  if (file->h5 >= 0 && !file->error) PetscCall(OutFileH5Room(file, row * dims[0]));
  if (file->h5 >= 0 && !file->error) PetscCall(OutFileH5Dataset(file, path, type, width > 1 ? 2 : 1, dims, &offset));
  if (offset != HADDR_UNDEF) PetscCall(OutFileH5Rows(file, offset, row * dims[0]));
  PetscCallMPI(MPI_Bcast(&offset, 1, MPI_UINT64_T, 0, file->comm));
  if (offset == HADDR_UNDEF) PetscFunctionReturn(0); /* noted by the first rank, or nothing to write */
  PetscCall(OutFileWriteAt(file, values, row * (size_t)rows->n_local, (off_t)(offset + row * (uint64_t)rows->first)));
  PetscFunctionReturn(0);
}

/* Attaches n values of a type to the object `path`; n = 0 stands for one value without dimension */
static PetscErrorCode OutFileH5Attribute(OutFile *file, const char path[], const char attribute[], hid_t type,
                                         hsize_t n, const void *values)
{
  hid_t  space, id;
  herr_t result;

  PetscFunctionBeginUser;
  H5Quietly(space, n > 0 ? H5Screate_simple(1, &n, NULL) : H5Screate(H5S_SCALAR));
  H5Quietly(id, H5Acreate_by_name(file->h5, path, attribute, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Quietly(result, H5Awrite(id, type, values));
  PetscCall(OutFileH5Note(file, result));
  H5Quietly(result, H5Aclose(id));
  H5Quietly(result, H5Sclose(space));
  PetscFunctionReturn(0);
}

/* Attaches integers to an object of the file */
PetscErrorCode OutFileH5Integers(OutFile *file, const char path[], const char attribute[], PetscInt n,
                                 const int values[])
{
  PetscFunctionBeginUser;
  if (file->h5 < 0 || file->error) PetscFunctionReturn(0);
  PetscCall(OutFileH5Attribute(file, path, attribute, H5T_NATIVE_INT, (hsize_t)n, values));
  PetscFunctionReturn(0);
}

/*
   Attaches strings of equal, fixed length to an object of the file, as VTK wants them; n = 0 stands for a single
   string without dimension.
*/
PetscErrorCode OutFileH5Strings(OutFile *file, const char path[], const char attribute[], PetscInt n,
                                const char *const strings[])
{
  size_t         length = 1, used;
  char          *block;
  hid_t          type;
  const PetscInt count = PetscMax(n, 1);

  PetscFunctionBeginUser;
  if (file->h5 < 0 || file->error) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < count; i++) {
    PetscCall(PetscStrlen(strings[i], &used));
    length = PetscMax(length, used);
  }
  PetscCall(PetscCalloc1((size_t)count * length, &block));
  for (PetscInt i = 0; i < count; i++) {
    PetscCall(PetscStrlen(strings[i], &used));
    PetscCall(PetscMemcpy(block + (size_t)i * length, strings[i], used));
  }
  type = H5Tcopy(H5T_C_S1);
  PetscCall(OutFileH5Note(file, H5Tset_size(type, length)));
  PetscCall(OutFileH5Note(file, H5Tset_strpad(type, H5T_STR_NULLPAD)));
  PetscCall(OutFileH5Attribute(file, path, attribute, type, (hsize_t)n, block));
  PetscCall(OutFileH5Note(file, H5Tclose(type)));
  PetscCall(PetscFree(block));
  PetscFunctionReturn(0);
}

/* Copies bytes [from, to) of HDF5's file in memory */
static PetscErrorCode OutFileH5Copy(OutFile *file, uint64_t from, uint64_t to)
{
  char *block;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(H5_BLOCK, &block));
  for (; from < to && !file->error; from += H5_BLOCK) {
    const size_t size = (size_t)PetscMin(H5_BLOCK, to - from);

    PetscCall(
      OutFileNote(file, pread(file->memory, block, size, (off_t)from) == (ssize_t)size ? PETSC_FALSE : PETSC_TRUE));
    PetscCall(OutFileWriteAt(file, block, size, (off_t)from));
  }
  PetscCall(PetscFree(block));
  PetscFunctionReturn(0);
}

/* Copies all that HDF5 has put between the rows, when it has closed its file */
static PetscErrorCode OutFileH5CopyRest(OutFile *file)
{
  const off_t end  = lseek(file->memory, 0, SEEK_END);
  uint64_t    from = 0;

  PetscFunctionBeginUser;
  PetscCall(OutFileNote(file, end < 0 ? PETSC_TRUE : PETSC_FALSE));
  for (PetscInt i = 0; i < file->n_rows && !file->error; i++) {
    PetscCall(OutFileH5Copy(file, from, file->rows[i].offset));
    from = file->rows[i].offset + file->rows[i].size;
  }
  if (!file->error) PetscCall(OutFileH5Copy(file, from, (uint64_t)end));
  if (!file->error) PetscCall(OutFileNote(file, ftruncate(file->fd, end) ? PETSC_TRUE : PETSC_FALSE));
  PetscFunctionReturn(0);
}

/* Closes the file on this rank, if it is open */
PetscErrorCode OutFileH5Close(OutFile *file)
{
  herr_t result;

  PetscFunctionBeginUser;
  if (file->h5 >= 0) {
    H5Quietly(result, H5Fclose(file->h5));
    PetscCall(OutFileH5Note(file, result));
    file->h5 = H5I_INVALID_HID;
    if (!file->error) PetscCall(OutFileH5CopyRest(file));
  }
  PetscCall(PetscFree(file->rows));
  file->n_rows = 0;
  if (file->memory >= 0) (void)close(file->memory);
  file->memory = -1;
  if (file->fd >= 0) {
    PetscCall(OutFileNote(file, close(file->fd) ? PETSC_TRUE : PETSC_FALSE));
    file->fd = -1;
  }
  PetscFunctionReturn(0);
}
