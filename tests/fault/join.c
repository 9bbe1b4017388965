/*
   Stands under mpirun in place of the program, which it has a loop start that has loaded its libraries already (serve.c),
   at the socket SQUEAL_SERVED:

     mpirun -n 2 join PROGRAM ARGUMENTS

   The program gets this process's folder, streams, environment and signals; this process ends as it does.
*/
#define _GNU_SOURCE
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

static int    connection;
static char   request[131072];
static size_t used = sizeof(int32_t);

static void Add(const char text[])
{
  const size_t size = strlen(text) + 1;

  if (used + size > sizeof(request)) _exit(98);
  memcpy(request + used, text, size);
  used += size;
}

static void AddNumber(const char format[], int number)
{
  char text[64];

  (void)snprintf(text, sizeof(text), format, number);
  Add(text);
}

static void PassOn(int number)
{
  const int32_t sent = number;

  if (write(connection, &sent, sizeof(sent)) < 0) _exit(97);
}

/* Folder, streams, environment, command */
static void Describe(char **argv)
{
  char    folder[4096];
  int     n = 0;
  int32_t size;

  Add(getcwd(folder, sizeof(folder)) ? folder : "/");
  AddNumber("/proc/%d/fd/1", getpid());
  AddNumber("/proc/%d/fd/2", getpid());
  while (environ[n]) n++;
  AddNumber("%d", n);
  for (int i = 0; i < n; i++) Add(environ[i]);
  for (int i = 1; argv[i]; i++) Add(argv[i]);
  size = (int32_t)(used - sizeof(size));
  memcpy(request, &size, sizeof(size));
}

static int32_t Answer(void)
{
  int32_t value;
  ssize_t n;

  do n = recv(connection, &value, sizeof(value), MSG_WAITALL);
  while (n < 0); /* a signal came in */
  if (n != (ssize_t)sizeof(value)) _exit(96);
  return value;
}

int main(int argc, char **argv)
{
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  const char        *path    = getenv("SQUEAL_SERVED");
  const int          passed[] = {SIGINT, SIGTERM, SIGUSR1, SIGCONT};
  int                status;

  if (argc < 2 || !path || strlen(path) >= sizeof(address.sun_path)) return 95;
  (void)strcpy(address.sun_path, path);
  connection = socket(AF_UNIX, SOCK_STREAM, 0);
  if (connect(connection, (struct sockaddr *)&address, sizeof(address))) return 94;
  Describe(argv);
  if (send(connection, request, used, 0) != (ssize_t)used) return 93;
  (void)Answer();
  for (size_t i = 0; i < sizeof(passed) / sizeof(passed[0]); i++) (void)signal(passed[i], PassOn);
  status = Answer();
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  (void)signal(WTERMSIG(status), SIG_DFL);
  (void)raise(WTERMSIG(status));
  return 92;
}
