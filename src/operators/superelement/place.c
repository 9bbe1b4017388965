/*
   What the unknowns of a superelement are in the mesh: its place is that of a node, u_s = u_d; or of a point, whose six
   motions are means over its set; or it lies on a surface, which it follows as the slaves of a tie do (contact/tie),
   u_s = sum_i w_i u_i + omega x g. Each as shares of displacements of nodes, held ones too.
*/
#include "superelement.h"
#include "base/algebra/vec3.h"
#include <stdlib.h>

#define SUPERELEMENT_NEAR 1e-5 /* of the size of the mesh: how near a place is to its node or point */
#define SUPERELEMENT_UNIT 0.01 /* of 1000: a mesh in m beside places in mm */

/* SuperPlaces of unknowns that are not apart, as they are looked for */
typedef struct {
  Operators     operators;
  Superelement *s;
  const Mesh   *mesh;
  PetscBool    *on; /* [nodes] of -..._sets; NULL: all */
  PetscInt      n, *row, room;
  PetscReal     near;            /* m */
  NearestNode  *found;           /* [n] */
  PetscInt     *point;           /* [n] index of a point, -1 */
  PetscInt     *number, *vertex; /* own nodes: global numbers, ascending, and local nodes */
  PetscInt      n_own;
} SuperelementPlaces;

/* Adds a share of displacement d of local node v */
static PetscErrorCode ShareAdd(SuperelementPlaces *p, PetscInt row, PetscInt v, int d, PetscReal weight)
{
  Superelement *s = p->s;

  PetscFunctionBeginUser;
  if (weight == 0) PetscFunctionReturn(0);
  if (s->n_shares == p->room) {
    p->room = PetscMax(1024, 2 * p->room);
    PetscCall(PetscRealloc((size_t)p->room * sizeof(*s->share), &s->share));
  }
  s->share[s->n_shares++] = (SuperelementShare){row, 3 * v + d, weight};
  PetscFunctionReturn(0);
}

/* The same of the node of a global number, where this rank owns it */
static PetscErrorCode ShareAddNumber(SuperelementPlaces *p, PetscInt row, PetscInt number, int d, PetscReal weight)
{
  PetscInt at;

  PetscFunctionBeginUser;
  PetscCall(PetscFindInt(number, p->n_own, p->number, &at));
  if (at >= 0) PetscCall(ShareAdd(p, row, p->vertex[at], d, weight));
  PetscFunctionReturn(0);
}

/* A motion of a point, which a set on one line has not */
static PetscErrorCode ShareAddPoint(SuperelementPlaces *p, PetscInt row, const Joint *point, PetscInt motion)
{
  const ModelMean *mean = &point->mean;
  PetscReal        most = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * mean->n; i++) {
    PetscCall(ShareAdd(p, row, mean->vertex[i / 3], (int)(i % 3), mean->b[6 * i + motion]));
    most = PetscMax(most, PetscAbsReal(mean->b[6 * i + motion]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, p->operators->comm));
  PetscCheck(most > 0, p->operators->comm, PETSC_ERR_USER_INPUT,
             "superelement %s: unknown %" PetscInt_FMT
             " is a rotation at point %s, the nodes of whose set %s stand on one line or in one place, where they have "
             "none: name a surface",
             p->s->name, row + 1, point->name, point->set[0]);
  PetscFunctionReturn(0);
}

static PetscErrorCode PlacesMarkSets(SuperelementPlaces *p)
{
  PetscFunctionBeginUser;
  if (!p->s->n_sets) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(p->mesh->n_nodes, &p->on));
  for (PetscInt i = 0; i < p->s->n_sets; i++) {
    PetscInt n, *node;

    PetscCall(ModelGetSetNodes(p->operators->model, p->s->sets[i], &n, &node));
    for (PetscInt k = 0; k < n; k++) p->on[node[k]] = PETSC_TRUE;
    PetscCall(PetscFree(node));
  }
  PetscFunctionReturn(0);
}

/* The unknowns that have a place, and the nodes of this rank by number */
static PetscErrorCode PlacesCreate(Operators o, Superelement *s, SuperelementPlaces *p)
{
  const PetscInt n = s->n - s->n_apart;

  PetscFunctionBeginUser;
  *p = (SuperelementPlaces){.operators = o, .s = s, .n = 0};
  PetscCall(ModelGetMesh(o->model, &p->mesh));
  PetscCall(MeshSize(o->comm, p->mesh, &p->near));
  p->near = s->distance > 0 ? s->distance : SUPERELEMENT_NEAR * p->near;
  PetscCall(PetscMalloc3(n, &p->row, n, &p->found, n, &p->point));
  for (PetscInt i = 0; i < s->n; i++) {
    if (s->row[i].direction == SUPERELEMENT_APART) continue;
    PetscCall(PetscArraycpy(p->found[p->n].x, s->row[i].x, 3));
    p->row[p->n++] = i;
  }
  PetscCall(PetscMalloc2(p->mesh->n_nodes, &p->number, p->mesh->n_nodes, &p->vertex));
  for (PetscInt v = 0; v < p->mesh->n_nodes; v++) {
    if (!p->mesh->owned[v]) continue;
    p->number[p->n_own]   = p->mesh->number[v];
    p->vertex[p->n_own++] = v;
  }
  PetscCall(PetscSortIntWithArray(p->n_own, p->number, p->vertex));
  PetscCall(PlacesMarkSets(p));
  PetscFunctionReturn(0);
}

static PetscErrorCode PlacesDestroy(SuperelementPlaces *p)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(p->on));
  PetscCall(PetscFree3(p->row, p->found, p->point));
  PetscCall(PetscFree2(p->number, p->vertex));
  PetscFunctionReturn(0);
}

/* Index of the point at a place, -1 without */
static PetscInt PointAt(const ModelScene *scene, const PetscReal x[3], PetscReal near, PetscReal *off)
{
  for (PetscInt i = 0; i < scene->n_points; i++) {
    const PetscReal *at = scene->points[i].at, way[3] = {at[0] - x[0], at[1] - x[1], at[2] - x[2]};

    if (Vec3Length(way) > near) continue;
    *off = PetscMax(*off, Vec3Length(way));
    return i;
  }
  return -1;
}

/* Nodes that have a rotation, ascending */
static PetscErrorCode NodesThatTurn(const Superelement *s, PetscInt *n, PetscInt **node)
{
  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(PetscMalloc1(s->n, node));
  for (PetscInt i = 0; i < s->n; i++)
    if (s->row[i].direction >= 3) (*node)[(*n)++] = s->row[i].node;
  PetscCall(PetscSortRemoveDupsInt(n, *node));
  PetscFunctionReturn(0);
}

/* Points: of what turns, and of what is at no node of the mesh. A rotation that is at no point is an error. */
static PetscErrorCode PlacesFindPoints(SuperelementPlaces *p)
{
  const ModelScene *scene;
  PetscInt          n, *turns, at;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(p->operators->model, &scene));
  PetscCall(NodesThatTurn(p->s, &n, &turns));
  for (PetscInt i = 0; i < p->n; i++) {
    const SuperelementRow *row = &p->s->row[p->row[i]];
    const PetscReal       *x   = row->x;

    PetscCall(PetscFindInt(row->node, n, turns, &at));
    p->point[i] = at >= 0 || p->found[i].number < 0 ? PointAt(scene, x, p->near, &p->s->off) : -1;
    PetscCheck(at < 0 || p->point[i] >= 0, p->operators->comm, PETSC_ERR_USER_INPUT,
               "superelement %s: node %" PetscInt_FMT " at %.6g, %.6g, %.6g m has rotations, and is at none of "
               "-points: make one there, whose set carries it",
               p->s->name, row->node, (double)x[0], (double)x[1], (double)x[2]);
  }
  PetscCall(PetscFree(turns));
  PetscFunctionReturn(0);
}

/* "; in mm, all would lie within 0.001 m": where places are a thousand times farther from the origin than nodes */
static PetscErrorCode PlacesGuessUnit(const SuperelementPlaces *p, size_t size, char text[])
{
  PetscReal far[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < 3 * p->n; i++) far[0] = PetscMax(far[0], PetscAbsReal(p->found[i / 3].x[i % 3]));
  for (PetscInt i = 0; i < 3 * p->mesh->n_nodes; i++) far[1] = PetscMax(far[1], PetscAbsReal(p->mesh->x[i]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, far, 2, MPIU_REAL, MPI_MAX, p->operators->comm));
  text[0] = '\0';
  if (far[0] > 1000 * 30 * SUPERELEMENT_UNIT * far[1])
    PetscCall(PetscStrncpy(text, "; is the table in mm, the mesh in m?", size));
  else if (far[1] > 1000 * 30 * SUPERELEMENT_UNIT * far[0])
    PetscCall(PetscStrncpy(text, "; is the table in m, the mesh in mm?", size));
  PetscFunctionReturn(0);
}

/* Raises the error for the first place that is at nothing: how many there are, how far that one is from a node */
static PetscErrorCode PlacesCheckFar(const SuperelementPlaces *p, PetscInt n_far, PetscInt first)
{
  const SuperelementRow *row = &p->s->row[p->row[first]];
  NearestNode            nearest;
  char                   unit[128];

  PetscFunctionBeginUser;
  PetscCall(PlacesGuessUnit(p, sizeof(unit), unit));
  PetscCall(PetscArraycpy(nearest.x, row->x, 3));
  PetscCall(NodesFindNearest(p->operators->comm, p->mesh, p->on, PETSC_MAX_REAL, 1, &nearest));
  SETERRQ(p->operators->comm, PETSC_ERR_USER_INPUT,
          "superelement %s: %" PetscInt_FMT " of %" PetscInt_FMT " unknowns that are not internal lie on no node%s, "
          "point or surface of -%s_sets; unknown %" PetscInt_FMT " of node %" PetscInt_FMT
          " at %.6g, %.6g, %.6g m is %.6g m from the nearest node, farther than -%s_distance %.3g m%s",
          p->s->name, n_far, p->n, p->on ? " of -..._sets" : "", p->s->name, p->row[first] + 1, row->node,
          (double)row->x[0], (double)row->x[1], (double)row->x[2], (double)nearest.distance, p->s->name,
          (double)p->near, unit);
}

/* Surfaces among the sets carry what is at no node and no point; the rest is an error */
static PetscErrorCode PlacesFollow(SuperelementPlaces *p)
{
  PetscInt         n = 0, m = 0, *which;
  ContactFollower *place;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(p->n, &which, p->n, &place));
  for (PetscInt i = 0; i < p->n; i++)
    if (p->found[i].number < 0 && p->point[i] < 0) which[n++] = i;
  for (PetscInt k = 0; k < p->s->n_sets && n; k++, n = m, m = 0) {
    for (PetscInt i = 0; i < n; i++) PetscCall(PetscArraycpy(place[i].x, p->found[which[i]].x, 3));
    PetscCall(ContactFollow(p->operators->contact, p->s->sets[k], p->s->distance, n, place));
    for (PetscInt i = 0; i < n; i++) {
      const PetscInt row = p->row[which[i]], d = p->s->row[row].direction;

      for (PetscInt j = 0; j < 3 * place[i].n_master; j++) {
        const ContactLinkNode *node = &place[i].master[j / 3];

        PetscCall(ShareAddNumber(p, row, node->number, (int)(j % 3), node->follow[3 * d + j % 3]));
      }
      if (place[i].n_master)
        p->s->n_follow++, p->s->off = PetscMax(p->s->off, place[i].off);
      else
        which[m++] = which[i];
    }
  }
  if (n) PetscCall(PlacesCheckFar(p, n, which[0]));
  PetscCall(PetscFree2(which, place));
  PetscFunctionReturn(0);
}

/* Shares of nodes and points; an error where two nodes are equally near */
static PetscErrorCode PlacesTake(SuperelementPlaces *p)
{
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(p->operators->model, &scene));
  for (PetscInt i = 0; i < p->n; i++) {
    const PetscInt         k    = p->row[i];
    const SuperelementRow *row  = &p->s->row[k];
    const NearestNode     *node = &p->found[i];

    if (p->point[i] >= 0) PetscCall(ShareAddPoint(p, k, &scene->points[p->point[i]], row->direction));
    if (p->point[i] >= 0 || node->number < 0) continue;
    PetscCheck(!node->twice, p->operators->comm, PETSC_ERR_USER_INPUT,
               "superelement %s: unknown %" PetscInt_FMT " of node %" PetscInt_FMT
               " at %.6g, %.6g, %.6g m is where two nodes of the mesh are: name the set of one by -%s_sets",
               p->s->name, k + 1, row->node, (double)row->x[0], (double)row->x[1], (double)row->x[2], p->s->name);
    p->s->off = PetscMax(p->s->off, node->distance);
    PetscCall(ShareAddNumber(p, k, node->number, (int)row->direction, 1));
  }
  PetscFunctionReturn(0);
}

/* Raises an error where a motion moves what a superelement is joined to: its forces would act on unknowns apart */
static PetscErrorCode PlacesCheckMotions(const SuperelementPlaces *p)
{
  PetscInt moved = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < p->s->n_shares && p->mesh->prescribed; i++)
    if (p->mesh->prescribed[p->s->share[i].at] != 0) moved = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &moved, 1, MPIU_INT, MPI_MAX, p->operators->comm));
  PetscCheck(!moved, p->operators->comm, PETSC_ERR_SUP,
             "superelement %s: -motions move nodes that it is joined to, which is not supported: move other ones",
             p->s->name);
  PetscFunctionReturn(0);
}

PetscErrorCode OperatorsCheckSpinningSuperelements(Operators o, PetscInt part)
{
  const Mesh *mesh;
  PetscBool  *on;

  PetscFunctionBeginUser;
  if (!o->n_superelements) PetscFunctionReturn(0);
  PetscCall(ModelGetMesh(o->model, &mesh));
  PetscCall(OperatorsMarkPart(mesh, part, &on));
  for (PetscInt i = 0; i < o->n_superelements; i++) {
    const Superelement *s     = &o->superelements[i];
    PetscBool           spins = PETSC_FALSE;

    for (PetscInt k = 0; k < s->n_shares; k++)
      if (on[s->share[k].at / 3]) spins = PETSC_TRUE;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &spins, 1, MPIU_BOOL, MPI_LOR, o->comm));
    PetscCheck(!spins, o->comm, PETSC_ERR_SUP,
               "superelement %s is joined to part %s, which -%s_spin turns: that is not supported", s->name,
               mesh->part[part], mesh->part[part]);
  }
  PetscCall(PetscFree(on));
  PetscFunctionReturn(0);
}

PetscErrorCode SuperelementPlace(Operators o, Superelement *s)
{
  SuperelementPlaces p;

  PetscFunctionBeginUser;
  PetscCall(PlacesCreate(o, s, &p));
  PetscCall(NodesFindNearest(o->comm, p.mesh, p.on, p.near, p.n, p.found));
  PetscCall(PlacesFindPoints(&p));
  PetscCall(PlacesTake(&p));
  PetscCall(PlacesFollow(&p));
  PetscCall(PlacesCheckMotions(&p));
  PetscCall(PlacesDestroy(&p));
  PetscFunctionReturn(0);
}
