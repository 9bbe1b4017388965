/*
   Starts the program again and again: instead of main() runs a loop that forks a child for each request, in which main()
   begins with other arguments, when FAULT_SERVE is the number of a file, a socket that listens. The libraries, two thirds
   of what a tiny scene costs, are then loaded once, those of FAULT_LOAD too. Nothing of the program has run before the
   fork. The loop ends with its standard input.

   Who connects sends requests, one after the other. A request is a number of bytes (int32) and as many bytes, strings that
   end in a zero each: folder to work in, files for standard output and error, number of lines of the environment, these
   lines, arguments from argv[0]. The answers: the child's process (int32), and at its end the status of waitpid(2)
   (int32). In between come numbers of signals (int32) for the child, which get to it from its parent as those of a
   launcher do; the end of the connection kills it.
*/
#define _GNU_SOURCE
#include "inject.h"
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#define MOST_BYTES 131072
#define MOST_WORDS 1024

typedef int (*Main)(int, char **, char **);
typedef int (*Start)(Main, int, char **, void (*)(void), void (*)(void), void (*)(void), void *);

static Main program;

static int ReadAll(int file, void *to, size_t size)
{
  for (size_t done = 0; done < size;) {
    const ssize_t n = read(file, (char *)to + done, size - done);

    if (n <= 0) return 0;
    done += (size_t)n;
  }
  return 1;
}

/* Splits a request into its strings; their number */
static int Split(char *bytes, int32_t size, char *words[])
{
  int n = 0;

  for (char *at = bytes; at < bytes + size && n < MOST_WORDS; at += strlen(at) + 1) words[n++] = at;
  words[n] = NULL;
  return n;
}

/* Puts a file in place of a standard stream */
static void Redirect(const char path[], int flags, int stream)
{
  const int fd = open(path, flags, 0666);

  if (fd < 0 || dup2(fd, stream) < 0) _exit(99);
  (void)close(fd);
}

/* The child: never returns to the loop */
static int Child(int n, char *words[])
{
  const int n_lines = atoi(words[3]);

  if (chdir(words[0])) _exit(99);
  Redirect("/dev/null", O_RDONLY, STDIN_FILENO);
  Redirect(words[1], O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
  Redirect(words[2], O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
  for (int i = 0; i < n_lines; i++) (void)putenv(words[4 + i]);
  FaultSetUp();
  return program(n - 4 - n_lines, words + 4 + n_lines, environ);
}

/* Status of the child's end, up to which signals come in for it */
static int32_t Watch(int connection, pid_t child)
{
  struct pollfd watched[2] = {{.fd = (int)syscall(SYS_pidfd_open, child, 0), .events = POLLIN},
                              {.fd = connection, .events = POLLIN}};
  int32_t       number;
  int           status = 0;

  while (poll(watched, 2, -1) > 0 && !watched[0].revents) {
    if (!ReadAll(connection, &number, sizeof(number))) {
      number        = SIGKILL;
      watched[1].fd = -1;
    }
    (void)kill(child, number);
  }
  (void)close(watched[0].fd);
  (void)waitpid(child, &status, 0);
  return status;
}

/* The requests of one connection */
static int Answer(int connection)
{
  static char bytes[MOST_BYTES];
  char       *words[MOST_WORDS + 1];
  int32_t     size, status;

  while (ReadAll(connection, &size, sizeof(size)) && size > 0 && size < MOST_BYTES && ReadAll(connection, bytes, (size_t)size)) {
    const int     n     = Split(bytes, size, words);
    const int32_t child = fork();

    if (child == 0) (void)close(connection);
    if (child == 0) return Child(n, words);
    if (child < 0 || write(connection, &child, sizeof(child)) < 0) break;
    status = Watch(connection, child);
    if (write(connection, &status, sizeof(status)) < 0) break;
  }
  _exit(0);
}

/* Libraries that the program would load by name at each start, in a list with colons: a child finds them loaded */
static void LoadBefore(const char list[])
{
  char *names = strdup(list ? list : ""), *rest = NULL;

  for (char *name = strtok_r(names, ":", &rest); name; name = strtok_r(NULL, ":", &rest)) (void)dlopen(name, RTLD_NOW | RTLD_GLOBAL);
  free(names);
}

static int Serve(int listener)
{
  struct pollfd watched[2] = {{.fd = STDIN_FILENO, .events = POLLIN}, {.fd = listener, .events = POLLIN}};

  LoadBefore(getenv("FAULT_LOAD"));
  while (poll(watched, 2, -1) > 0 && !watched[0].revents) {
    const int connection = accept4(listener, NULL, NULL, SOCK_CLOEXEC);

    if (connection >= 0 && fork() == 0) {
      (void)close(listener);
      return Answer(connection);
    }
    (void)close(connection);
  }
  while (wait(NULL) > 0) continue; /* so that their time counts */
  return 0;
}

static int Begin(int argc, char **argv, char **environment)
{
  const char *listener = getenv("FAULT_SERVE");

  if (listener) return Serve(atoi(listener));
  FaultSetUp();
  return program(argc, argv, environment);
}

/* The C library's, which calls main() */
int __libc_start_main(Main main, int argc, char **argv, void (*init)(void), void (*fini)(void), void (*rtld_fini)(void),
                      void *stack_end)
{
  Start next;

  FaultNext("__libc_start_main", &next);
  program = main;
  return next(Begin, argc, argv, init, fini, rtld_fini, stack_end);
}
