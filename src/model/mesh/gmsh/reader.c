/*
   Numbers from a file that is text or binary in the byte order of this machine.
*/
#include "reader.h"

#include <stdarg.h>

static const char blanks[] = " \t\r\n";

void ReaderErrorSet(ReaderError *error, PetscErrorCode code, const char format[], ...)
{
  va_list values;

  if (error->code) return;
  error->code = code;
  va_start(values, format);
  vsnprintf(error->text, sizeof(error->text), format, values);
  va_end(values);
}

/* Whether a number of text ends where a blank or the file's end follows: of 0.06.01 not the half is read */
static PetscBool WordEnds(MeshReader *r)
{
  const int next = fgetc(r->file);

  if (next == EOF) return PETSC_TRUE;
  (void)ungetc(next, r->file);
  return strchr(blanks, next) ? PETSC_TRUE : PETSC_FALSE;
}

/* The next integer of INT_BYTES or SIZE_BYTES; 0 after an error */
int64_t ReadInteger(MeshReader *r, int bytes)
{
  long long text  = 0;
  int32_t   small = 0;
  int64_t   value = 0;
  int       n;

  if (r->error->code) return 0;
  if (!r->binary) {
    n     = fscanf(r->file, "%lld", &text) == 1 && WordEnds(r);
    value = text;
  } else if (bytes == INT_BYTES) {
    n     = (int)fread(&small, INT_BYTES, 1, r->file);
    value = small;
  } else
    n = (int)fread(&value, SIZE_BYTES, 1, r->file);
  if (n == 1) return value;
  ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "section $%s ends or holds no integer at some place", r->section);
  return 0;
}

/* A tag, which fits into PetscInt */
PetscInt ReadTag(MeshReader *r, int bytes)
{
  const int64_t value = ReadInteger(r, bytes);

  if (value >= -PETSC_MAX_INT && value <= PETSC_MAX_INT) return (PetscInt)value;
  ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "number %lld in section $%s is too large", (long long)value,
                 r->section);
  return 0;
}

/* A count that the file can hold and that leaves room for arrays of some words per item */
static PetscInt CheckCount(MeshReader *r, int64_t count)
{
  if (count >= 0 && count <= r->most) return (PetscInt)count;
  ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "section $%s announces %lld items", r->section, (long long)count);
  return 0;
}

PetscInt ReadCount(MeshReader *r, int bytes)
{
  return CheckCount(r, ReadInteger(r, bytes));
}

/* A count on a line of its own, which is text in binary files too */
PetscInt ReadCountLine(MeshReader *r)
{
  char      line[64], *end;
  long long n;

  if (r->error->code) return 0;
  if (!fgets(line, sizeof(line), r->file)) line[0] = '\0';
  n = strtoll(line, &end, 10);
  if (end > line && !end[strspn(end, blanks)]) return CheckCount(r, n);
  ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "section $%s does not begin with a count on a line of its own",
                 r->section);
  return 0;
}

void ReadReals(MeshReader *r, PetscInt n, PetscReal value[])
{
  for (PetscInt i = 0; i < n; i++) {
    double x = 0;
    int    m = 0;

    if (!r->error->code && r->binary) m = (int)fread(&x, sizeof(x), 1, r->file);
    if (!r->error->code && !r->binary) m = fscanf(r->file, "%lf", &x) == 1 && WordEnds(r);
    if (m != 1 || !isfinite(x))
      ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "section $%s ends or holds no finite number at some place",
                     r->section);
    value[i] = x;
  }
}

void ReadSectionEnd(MeshReader *r, PetscBool known)
{
  char rest[512] = "", end[40];

  while (!r->error->code && strncmp(rest, "$End", 4)) {
    if (!fgets(rest, sizeof(rest), r->file))
      ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "the file ends within $%s", r->section);
    else if (known && strncmp(rest, "$End", 4) && rest[strspn(rest, blanks)])
      ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "section $%s holds more than it announces", r->section);
  }
  (void)snprintf(end, sizeof(end), "$End%s", r->section);
  rest[strcspn(rest, blanks)] = '\0';
  if (strcmp(rest, end))
    ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "section $%s ends in '%s', not in '%s'", r->section, rest, end);
}
