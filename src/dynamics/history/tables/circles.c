/*
   circles.csv: displacement (m) of the nodes of the circles along their axis, a row as in transient.csv; and
   circle_nodes.csv: where these nodes are. Angles are measured about the circle's axis from the contact, the mean of
   the slaves' nodes, unless that lies on the axis itself.
*/
#include "dynamics/history/historyimpl.h"
#include "base/text.h"

#define CIRCLE_ROOM 288
/* of a circle's radius: nearer to the axis a contact has no angle */
#define ON_AXIS 1e-3

static PetscInt CirclesCount(History history)
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < history->n_circles; i++) n += history->circles[i].n;
  return n;
}

PetscErrorCode CirclesCreateHeader(History history, char **header)
{
  const size_t room = (size_t)(CirclesCount(history) + 1) * CIRCLE_ROOM;
  char         column[CIRCLE_ROOM];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(room, header));
  PetscCall(PetscStrncpy(*header, "time_s", room));
  for (PetscInt i = 0; i < history->n_circles; i++) {
    const Circle *c = &history->circles[i];

    for (PetscInt k = 0; k < c->n; k++) {
      PetscCall(PetscSNPrintf(column, sizeof(column), ",%s_%c_m", c->probe[k].name, "xyz"[c->axis]));
      PetscCall(TextAdd(*header, column, room));
    }
  }
  PetscFunctionReturn(0);
}

/* Each node is recorded by one rank, with zeros on others: their sum on rank 0, which alone writes. */
PetscErrorCode HistoryWriteCircles(History history, const HistoryState *state)
{
  const PetscInt n = CirclesCount(history);
  PetscReal     *row, u[3], v[3], a[3];
  PetscMPIInt    rank;
  PetscInt       column = 1;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(history->comm, &rank));
  PetscCall(PetscCalloc1(n + 1, &row));
  for (PetscInt i = 0; i < history->n_circles; i++) {
    const Circle *c = &history->circles[i];

    for (PetscInt k = 0; k < c->n; k++, column++) {
      if (c->probe[k].vertex < 0) continue;
      HistoryMotion(history->source.layout, state, c->probe[k].vertex, u, v, a);
      row[column] = u[c->axis];
    }
  }
  PetscCallMPI(MPI_Reduce(rank ? row : MPI_IN_PLACE, row, (PetscMPIInt)(n + 1), MPIU_REAL, MPI_SUM, 0, history->comm));
  row[0] = state->time;
  PetscCall(ResultsTableNumbers(history->circle_table, n + 1, row));
  PetscCall(ResultsTableCheck(history->circle_table));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(0);
}

/* Mean of the nodes of all slaves, m; n = 0 for none */
static PetscErrorCode CirclesFindContact(History history, PetscReal centre[3], PetscReal *n)
{
  PetscReal   sum[4] = {0, 0, 0, 0};
  const Mesh *mesh;
  PetscInt    n_local, *vertex;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(history->source.model, &mesh));
  for (PetscInt i = 0; history->source.interfaces && i < history->source.n_interfaces; i++) {
    PetscCall(ModelGetOwnedNodes(history->source.model, history->source.interfaces[i].slave, &n_local, &vertex));
    for (PetscInt k = 0; k < n_local; k++)
      for (int d = 0; d < 3; d++) sum[d] += mesh->x[3 * vertex[k] + d];
    sum[3] += (PetscReal)n_local;
    PetscCall(PetscFree(vertex));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, history->comm));
  *n = sum[3];
  for (int d = 0; d < 3; d++) centre[d] = *n > 0 ? sum[d] / *n : 0;
  PetscFunctionReturn(0);
}

/* Polar coordinates about the circle's axis, m and rad from the axis + 1 */
static void CirclePolar(const Circle *c, const PetscReal x[3], PetscReal polar[2])
{
  const int       a = (c->axis + 1) % 3, b = (c->axis + 2) % 3;
  const PetscReal p = x[a] - c->centre[a], q = x[b] - c->centre[b];

  polar[0] = PetscSqrtReal(p * p + q * q);
  polar[1] = atan2(q, p);
}

PetscErrorCode CirclesWriteNodes(History history)
{
  PetscReal    centre[3], n_slaves, from[2], at[2];
  ResultsTable table;

  PetscFunctionBeginUser;
  if (!history->n_circles) PetscFunctionReturn(0);
  PetscCall(CirclesFindContact(history, centre, &n_slaves));
  PetscCall(ResultsTableOpen(history->source.results, "circle_nodes",
                             "node,circle,x_m,y_m,z_m,axis,radius_m,angle_rad,from_contact", &table));
  for (PetscInt i = 0; i < history->n_circles; i++) {
    const Circle *c = &history->circles[i];
    PetscBool     has_angle;

    CirclePolar(c, centre, from);
    has_angle = n_slaves > 0 && from[0] > ON_AXIS * c->radius ? PETSC_TRUE : PETSC_FALSE;
    for (PetscInt k = 0; k < c->n; k++) {
      const PetscReal *x = c->probe[k].x;

      CirclePolar(c, x, at);
      PetscCall(ResultsTableRow(table, "%s,%s,%.15g,%.15g,%.15g,%c,%.15g,%.15g,%d", c->probe[k].name, c->name,
                                (double)x[0], (double)x[1], (double)x[2], "xyz"[c->axis], (double)at[0],
                                (double)remainder(at[1] - (has_angle ? from[1] : 0), 2 * PETSC_PI), (int)has_angle));
    }
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}
