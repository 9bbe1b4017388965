/*
   The points of a pressure law that is a table, from its option or from a file: closing (m), of a lining its strain or
   the compression of a sample (table.h), and pressure (Pa) in each line, with a comma between; a first line that begins
   with no number is a heading, empty lines and those that begin with # are none. Read on one rank, checked on all.
*/
#include "kind.h"
#include "base/file.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define POINTS_LINE 512

/* The points as they are read, and what is wrong */
typedef struct {
  PetscInt  n, line; /* numbers; lines */
  PetscReal number[PRESSURE_ROOM];
  char      fault[256];
} Points;

/* Two numbers of a line; false where it has none */
static PetscBool PointsParse(const char line[], PetscReal number[2])
{
  char *end = NULL;

  number[0] = strtod(line, &end);
  if (end == line || *(end += strspn(end, " \t")) != ',') return PETSC_FALSE;
  line      = end + 1;
  number[1] = strtod(line, &end);
  return end != line && !end[strspn(end, " \t\r\n")] ? PETSC_TRUE : PETSC_FALSE;
}

/* Whether a line is a heading: no number begins it, so that a first point with a slip of the pen is none */
static PetscBool PointsIsHeading(const char line[])
{
  char *end = NULL;

  (void)strtod(line, &end);
  return end == line ? PETSC_TRUE : PETSC_FALSE;
}

/* All lines, on the rank that calls */
static void PointsRead(const char file[], Points *points)
{
  FILE *stream = FileStream(file, "r");
  char  line[POINTS_LINE];

  if (!stream) (void)snprintf(points->fault, sizeof(points->fault), "%s", FileReason(errno));
  if (!stream) return;
  while (!points->fault[0] && fgets(line, POINTS_LINE, stream)) {
    const char *text = line + strspn(line, " \t\r\n");

    points->line++;
    if (!*text || *text == '#') continue;
    if (points->n + 2 > PRESSURE_ROOM)
      (void)snprintf(points->fault, sizeof(points->fault), "it has more than %d points", PRESSURE_ROOM / 2);
    else if (PointsParse(text, &points->number[points->n]))
      points->n += 2;
    else if (points->line > 1 || !PointsIsHeading(text))
      (void)snprintf(points->fault, sizeof(points->fault), "line %d is no closing,pressure", (int)points->line);
  }
  (void)fclose(stream);
}

/* The points of a file into the law */
static PetscErrorCode PointsTake(MPI_Comm comm, const char name[], const char file[], PressureLaw *law)
{
  Points      points = {.n = 0};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PointsRead(file, &points);
  PetscCallMPI(MPI_Bcast(&points, (PetscMPIInt)sizeof(points), MPI_BYTE, 0, comm));
  PetscCheck(!points.fault[0], comm, PETSC_ERR_FILE_UNEXPECTED, "cannot read '%s' of -%s_pressure_file: %s", file, name,
             points.fault);
  law->n_points = points.n;
  PetscCall(PetscMalloc1(points.n, &law->point));
  PetscCall(PetscArraycpy(law->point, points.number, points.n));
  PetscFunctionReturn(0);
}

/* Raises the error for points that are no law. The option gives n_points numbers: pairs from here on. */
static PetscErrorCode PointsCheck(MPI_Comm comm, const char option[], PressureLaw *law)
{
  PetscReal *p = law->point;

  PetscFunctionBeginUser;
  PetscCheck(law->n_points % 2 == 0 && law->n_points >= 4, comm, PETSC_ERR_USER_INPUT,
             "%s has %" PetscInt_FMT " numbers; give two points at least: closing,pressure,closing,pressure", option,
             law->n_points);
  law->n_points /= 2;
  PetscCheck(p[1] == 0, comm, PETSC_ERR_USER_INPUT,
             "%s: the first pressure is %.6g; give 0 at the closing where it begins", option, (double)p[1]);
  for (PetscInt i = 0; i < law->n_points; i++) {
    PetscCheck(!PetscIsInfOrNanReal(p[2 * i]) && !PetscIsInfOrNanReal(p[2 * i + 1]), comm, PETSC_ERR_USER_INPUT,
               "%s: point %" PetscInt_FMT " is no finite number", option, i + 1);
    PetscCheck(p[2 * i + 1] >= 0, comm, PETSC_ERR_USER_INPUT,
               "%s: the pressure %.6g of point %" PetscInt_FMT " must not be negative", option, (double)p[2 * i + 1],
               i + 1);
    PetscCheck(!i || (p[2 * i] > p[2 * i - 2] && p[2 * i + 1] > p[2 * i - 1]), comm, PETSC_ERR_USER_INPUT,
               "%s: closing and pressure must rise from point to point, and do not from %.6g, %.6g to %.6g, %.6g",
               option, (double)p[2 * i - 2], (double)p[2 * i - 1], (double)p[2 * i], (double)p[2 * i + 1]);
  }
  PetscFunctionReturn(0);
}

/* The steepest line of a table of strains over pressures, Pa */
static PetscReal StrainsModulus(const PressureLaw *law, PetscReal sample)
{
  PetscReal modulus = 0;

  for (const PetscReal *i = law->point; i < &law->point[2 * (law->n_points - 1)]; i += 2)
    modulus = PetscMax(modulus, sample * (i[3] - i[1]) / (i[2] - i[0]));
  return modulus;
}

/* Closings of the spring at the back of a lining from its strains: c_i = h (e_i - p_i / E) */
static PetscErrorCode PointsOfLining(MPI_Comm comm, const char name[], const char option[], PressureLaw *law)
{
  const PetscReal h = law->parameter[TABLE_THICKNESS], modulus = law->parameter[TABLE_LINING];
  const PetscReal sample   = law->parameter[TABLE_SAMPLE] > 0 ? law->parameter[TABLE_SAMPLE] : 1;
  const PetscReal steepest = StrainsModulus(law, sample);
  const PetscReal largest  = law->point[2 * (law->n_points - 1)] / sample;

  PetscFunctionBeginUser;
  if (h == 0) PetscFunctionReturn(0);
  PetscCheck(largest < 1, comm, PETSC_ERR_USER_INPUT,
             "%s has a strain of %.6g, must be below 1: strains are no percents, and compressions need "
             "-%s_pressure_sample in the same unit",
             option, (double)largest, name);
  PetscCheck(modulus == 0 || modulus > steepest, comm, PETSC_ERR_USER_INPUT,
             "-%s_pressure_modulus %.6g Pa must be above %.6g Pa, the largest modulus of a line of %s: the lining in "
             "the mesh takes a part of the strain; give it and the part in the mesh a larger modulus",
             name, (double)modulus, (double)steepest, option);
  for (PetscInt i = 0; i < law->n_points; i++) {
    law->point[2 * i] *= h / sample;
    if (modulus > 0) law->point[2 * i] -= h * law->point[2 * i + 1] / modulus;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode PressurePointsSet(MPI_Comm comm, const char name[], const char file[], PressureLaw *law)
{
  char option[256];

  PetscFunctionBeginUser;
  PetscCheck(!file[0] || !law->point, comm, PETSC_ERR_USER_INPUT,
             "-%s_pressure_table and -%s_pressure_file are given; give one of them", name, name);
  PetscCheck(file[0] || law->point, comm, PETSC_ERR_USER_INPUT,
             "-%s_pressure_law table needs -%s_pressure_table closing,pressure,... or -%s_pressure_file", name, name,
             name);
  PetscCall(PetscSNPrintf(option, sizeof(option), "-%s_pressure_%s", name, file[0] ? "file" : "table"));
  if (file[0]) PetscCall(PointsTake(comm, name, file, law));
  PetscCall(PointsCheck(comm, option, law));
  PetscCall(PointsOfLining(comm, name, option, law));
  PetscFunctionReturn(0);
}
