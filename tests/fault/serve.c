/*
   Starts the program again and again: instead of main() runs a loop that reads requests from standard input and forks a
   child for each, in which main() begins with other arguments, when FAULT_SERVE is set. The libraries, two thirds of
   what a tiny scene costs, are then loaded once. Nothing of the program has run before the fork.

   A request is a number of bytes (int32) and as many bytes, strings that end in a zero each: folder to work in, files for
   standard output and error, number of lines of the environment, these lines, arguments from argv[0]. The answers, on the
   standard output: the child's process (int32), and at its end the status of waitpid(2) (int32).
*/
#define _GNU_SOURCE
#include "inject.h"
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define MOST_BYTES 65536
#define MOST_WORDS 256

typedef int (*Main)(int, char **, char **);
typedef int (*Start)(Main, int, char **, void (*)(void), void (*)(void), void (*)(void), void *);

static Main program;

static int ReadAll(void *to, size_t size)
{
  for (size_t done = 0; done < size;) {
    const ssize_t n = read(STDIN_FILENO, (char *)to + done, size - done);

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

static int Serve(void)
{
  static char bytes[MOST_BYTES];
  char       *words[MOST_WORDS + 1];
  int32_t     size, status;

  while (ReadAll(&size, sizeof(size)) && size > 0 && size < MOST_BYTES && ReadAll(bytes, (size_t)size)) {
    const int     n     = Split(bytes, size, words);
    const int32_t child = fork();

    if (child == 0) return Child(n, words);
    if (write(STDOUT_FILENO, &child, sizeof(child)) < 0 || waitpid(child, &status, 0) < 0) break;
    if (write(STDOUT_FILENO, &status, sizeof(status)) < 0) break;
  }
  return 0;
}

static int Begin(int argc, char **argv, char **environment)
{
  if (getenv("FAULT_SERVE")) return Serve();
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
