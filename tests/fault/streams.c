/*
   Calls on files of the folder that is watched. What the C library does within itself nobody can stand between, so that
   streams to such files are made anew on top of the system's calls (fopencookie(3)).
*/
#define _GNU_SOURCE
/* Both names of each call are defined here, hence no header may give one the other's */
#undef _FILE_OFFSET_BITS
#undef _FORTIFY_SOURCE
#include "inject.h"
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#define MAX_FILES   1024
#define MAX_STREAMS 64

static char watched[MAX_FILES];
static struct {
  FILE *stream;
  int   fd;
} streams[MAX_STREAMS];

static int Watched(int fd)
{
  return fd >= 0 && fd < MAX_FILES && watched[fd];
}

int FaultOpen(const char path[], int flags, mode_t mode)
{
  const int mine = FaultPathWatched(path) && (flags & (O_WRONLY | O_RDWR));
  int       fd;

  if (mine && FaultTake(FAULT_OPEN, path)) return -1;
  fd = (int)syscall(SYS_openat, AT_FDCWD, path, flags, mode);
  if (fd >= 0 && fd < MAX_FILES) watched[fd] = (char)mine;
  return fd;
}

ssize_t FaultWrite(int fd, const void *bytes, size_t size)
{
  const int fault = Watched(fd) ? FaultTake(FAULT_WRITE, "write") : 0;

  if (fault == 2 && size > 1)
    size /= 2;
  else if (fault)
    return -1;
  return syscall(SYS_write, fd, bytes, size);
}

int FaultClose(int fd)
{
  const int fault = Watched(fd) ? FaultTake(FAULT_CLOSE, "close") : 0;
  const int error = errno, status = (int)syscall(SYS_close, fd);

  if (fd >= 0 && fd < MAX_FILES) watched[fd] = 0;
  if (fault) errno = error;
  return fault ? -1 : status;
}

/* The name of an open file; what lies in FAULT_DIR.kept is that in FAULT_DIR */
static void FileName(int fd, char path[], size_t size)
{
  static const char kept[] = ".kept/";
  const char *const dir    = getenv("FAULT_DIR");
  char              link[64], *at;
  ssize_t           n;

  (void)snprintf(link, sizeof(link), "/proc/self/fd/%d", fd);
  n = readlink(link, path, size - 1);
  if (n < 0) _exit(88);
  path[n] = 0;
  at      = strstr(path, kept);
  if (at && at >= path + strlen(dir) && !strncmp(at - strlen(dir), dir, strlen(dir)))
    (void)memmove(at, at + strlen(kept) - 1, strlen(at + strlen(kept) - 1) + 1);
}

void FaultFilesCopied(void)
{
  char path[4096];

  for (int fd = STDERR_FILENO + 1; fd < MAX_FILES; fd++) {
    const off_t offset = lseek(fd, 0, SEEK_CUR);
    struct stat status;
    int         copy;

    if (offset < 0 || fstat(fd, &status) || !S_ISREG(status.st_mode) || status.st_nlink == 0) continue; /* without a name */
    FileName(fd, path, sizeof(path));
    copy = (int)syscall(SYS_openat, AT_FDCWD, path, fcntl(fd, F_GETFL) & (O_ACCMODE | O_APPEND));
    if (copy < 0 || lseek(copy, offset, SEEK_SET) != offset || syscall(SYS_dup3, copy, fd, 0) < 0) _exit(87);
    (void)syscall(SYS_close, copy);
  }
}

/* --- the system's calls */

static int OpenFrom(const char path[], int flags, va_list more)
{
  return FaultOpen(path, flags, flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0);
}

int open(const char *path, int flags, ...)
{
  va_list more;
  int     fd;

  va_start(more, flags);
  fd = OpenFrom(path, flags, more);
  va_end(more);
  return fd;
}

int open64(const char *path, int flags, ...)
{
  va_list more;
  int     fd;

  va_start(more, flags);
  fd = OpenFrom(path, flags | O_LARGEFILE, more);
  va_end(more);
  return fd;
}

ssize_t write(int fd, const void *bytes, size_t size)
{
  return FaultWrite(fd, bytes, size);
}

ssize_t pwrite(int fd, const void *bytes, size_t size, off_t offset)
{
  const int fault = Watched(fd) ? FaultTake(FAULT_WRITE, "pwrite") : 0;

  if (fault == 2 && size > 1)
    size /= 2;
  else if (fault)
    return -1;
  return syscall(SYS_pwrite64, fd, bytes, size, offset);
}

ssize_t pwrite64(int fd, const void *bytes, size_t size, off64_t offset)
{
  return pwrite(fd, bytes, size, offset);
}

ssize_t writev(int fd, const struct iovec *pieces, int n)
{
  if (Watched(fd) && FaultTake(FAULT_WRITE, "writev")) return -1;
  return syscall(SYS_writev, fd, pieces, n);
}

int fsync(int fd)
{
  return Watched(fd) && FaultTake(FAULT_SYNC, "fsync") ? -1 : (int)syscall(SYS_fsync, fd);
}

int fdatasync(int fd)
{
  return Watched(fd) && FaultTake(FAULT_SYNC, "fdatasync") ? -1 : (int)syscall(SYS_fdatasync, fd);
}

int ftruncate(int fd, off_t size)
{
  return Watched(fd) && FaultTake(FAULT_WRITE, "ftruncate") ? -1 : (int)syscall(SYS_ftruncate, fd, size);
}

int ftruncate64(int fd, off64_t size)
{
  return ftruncate(fd, size);
}

/* Returns the error, and leaves errno */
int posix_fallocate(int fd, off_t from, off_t size)
{
  const int before = errno;
  const int failed =
    (Watched(fd) && FaultTake(FAULT_WRITE, "posix_fallocate")) || syscall(SYS_fallocate, fd, 0, from, size);
  const int error = failed ? errno : 0;

  errno = before;
  return error;
}

int posix_fallocate64(int fd, off64_t from, off64_t size)
{
  return posix_fallocate(fd, from, size);
}

int rename(const char *from, const char *to)
{
  if (FaultPathWatched(to) && FaultTake(FAULT_RENAME, to)) return -1;
  return (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}

int close(int fd)
{
  return FaultClose(fd);
}

int dup2(int from, int to)
{
  const int fd = (int)syscall(SYS_dup3, from, to, 0);

  if (fd >= 0 && fd < MAX_FILES) watched[fd] = (char)Watched(from);
  return fd;
}

/* A file system without locks */
int flock(int fd, int operation)
{
  if (!getenv("FAULT_NO_LOCKS")) return (int)syscall(SYS_flock, fd, operation);
  errno = ENOLCK;
  return -1;
}

/* --- streams */

static ssize_t CookieRead(void *cookie, char *bytes, size_t size)
{
  return read((int)(ssize_t)cookie, bytes, size);
}

static ssize_t CookieWrite(void *cookie, const char *bytes, size_t size)
{
  size_t done = 0;

  while (done < size) { /* as the C library does */
    const ssize_t n = FaultWrite((int)(ssize_t)cookie, bytes + done, size - done);

    if (n < 0) return 0;
    done += (size_t)n;
  }
  return (ssize_t)done;
}

static int CookieSeek(void *cookie, off64_t *offset, int from)
{
  const off64_t place = lseek64((int)(ssize_t)cookie, *offset, from);

  if (place >= 0) *offset = place;
  return place < 0 ? -1 : 0;
}

static int CookieClose(void *cookie)
{
  for (int i = 0; i < MAX_STREAMS; i++)
    if (streams[i].stream && streams[i].fd == (int)(ssize_t)cookie) streams[i].stream = NULL;
  return FaultClose((int)(ssize_t)cookie);
}

static FILE *StreamOn(int fd, const char mode[])
{
  const cookie_io_functions_t functions = {CookieRead, CookieWrite, CookieSeek, CookieClose};
  FILE *const                 stream    = fopencookie((void *)(ssize_t)fd, mode, functions);

  for (int i = 0; i < MAX_STREAMS && stream; i++) {
    if (streams[i].stream) continue;
    streams[i].stream = stream;
    streams[i].fd     = fd;
    break;
  }
  return stream;
}

/* Flags of open() for a mode of fopen() */
static int ModeFlags(const char mode[])
{
  const int more = mode[0] == 'w' ? O_CREAT | O_TRUNC : mode[0] == 'a' ? O_CREAT | O_APPEND : 0;

  return more | (strchr(mode, '+') ? O_RDWR : mode[0] == 'r' ? O_RDONLY : O_WRONLY);
}

FILE *fopen(const char *path, const char *mode)
{
  FILE *(*next)(const char *, const char *);
  int fd;

  FaultNext("fopen", &next);
  if (!FaultPathWatched(path) || ModeFlags(mode) == O_RDONLY) return next(path, mode);
  fd = FaultOpen(path, ModeFlags(mode), 0666);
  return fd < 0 ? NULL : StreamOn(fd, mode);
}

FILE *fopen64(const char *path, const char *mode)
{
  return fopen(path, mode);
}

FILE *fdopen(int fd, const char *mode)
{
  FILE *(*next)(int, const char *);

  FaultNext("fdopen", &next);
  return Watched(fd) ? StreamOn(fd, mode) : next(fd, mode);
}

int fileno(FILE *stream)
{
  int (*next)(FILE *);

  FaultNext("fileno", &next);
  for (int i = 0; i < MAX_STREAMS; i++)
    if (streams[i].stream == stream) return streams[i].fd;
  return next(stream);
}
