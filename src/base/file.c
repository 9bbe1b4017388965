/*
   Regular files: opened without waiting for whoever would write into a pipe, and created under a name that nobody else
   can have taken in between (open(2): O_EXCL follows no link).
*/
#include "file.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* Closes what was opened in vain; errno says why */
static int FileGiveUp(int fd, int error)
{
  (void)close(fd);
  errno = error;
  return -1;
}

int FileOpen(const char path[], int flags)
{
  const int   fd = open(path, flags | O_NONBLOCK | O_CLOEXEC, 0666);
  struct stat what;

  /* a pipe that nobody reads, a socket, a link */
  if (fd < 0 && (errno == ENXIO || errno == ELOOP)) errno = FILE_NO_REGULAR;
  if (fd < 0) return -1;
  if (fstat(fd, &what)) return FileGiveUp(fd, errno);
  return S_ISREG(what.st_mode) ? fd : FileGiveUp(fd, S_ISDIR(what.st_mode) ? EISDIR : FILE_NO_REGULAR);
}

/* A stream on what is open; takes it over */
static FILE *StreamOn(int fd, const char mode[])
{
  FILE *const stream = fd < 0 ? NULL : fdopen(fd, mode);

  if (fd >= 0 && !stream) (void)FileGiveUp(fd, errno);
  return stream;
}

FILE *FileStream(const char path[], const char mode[])
{
  return StreamOn(FileOpen(path, strchr(mode, '+') ? O_RDWR : O_RDONLY), mode);
}

int FileCreate(const char path[], int access)
{
  struct stat what;

  if (!lstat(path, &what) && !S_ISREG(what.st_mode)) {
    errno = FILE_NO_REGULAR;
    return -1;
  }
  return unlink(path) && errno != ENOENT ? -1 : open(path, access | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

FILE *FileCreateStream(const char path[], const char mode[])
{
  return StreamOn(FileCreate(path, strchr(mode, '+') ? O_RDWR : O_WRONLY), mode);
}

int FileMake(const char path[])
{
  const int fd = FileCreate(path, O_WRONLY);

  return fd < 0 || close(fd) ? errno : 0;
}

int FolderLock(const char dir[])
{
  const int fd = open(dir, O_RDONLY | O_DIRECTORY | O_CLOEXEC);

  errno = 0;
  if (fd < 0 || !flock(fd, LOCK_EX | LOCK_NB)) return fd;
  return FileGiveUp(fd, errno == EWOULDBLOCK ? errno : 0);
}

hid_t FileH5Access(void)
{
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);

  if (access >= 0) (void)H5Pset_file_locking(access, PETSC_FALSE, PETSC_TRUE);
  return access;
}

hid_t FileH5Open(const char path[])
{
  const hid_t access = FileH5Access();
  const int   fd     = FileOpen(path, O_RDONLY);
  const hid_t file   = fd < 0 ? H5I_INVALID_HID : H5Fopen(path, H5F_ACC_RDONLY, access);

  if (fd >= 0) (void)close(fd);
  (void)H5Pclose(access);
  return file;
}

const char *FileReason(int error)
{
  return error == FILE_NO_REGULAR ? "it is no regular file" : strerror(error);
}
