/*
   Joints: bushings between the mean motions of two sets, or of one and the ground, and points, which stand for what is
   fastened to a set: its mass and inertia, and what holds it. All act on the six motions q = B u about a place x_0
   (mean.c), of two sets on the difference q_a - q_b,

      K += B' diag(k) B,     C += B' diag(c) B,     M += B' diag(m, m, m, J) B,

   in axes of its own where it has them, which is exact for rigid motions: B u is the motion of the point, and a
   bushing does not resist where both of its sides move as one rigid body. J is the inertia about x_0, where the centre
   of mass is.

   The motion of set b may be taken at a place of its own, as that of a spring between two nodes is. The joint then
   resists turns of both sides as one body.

   The nodes of a set that is joined rigidly move as one rigid body (operators/points/rigid.c).

   J = [xx xy xz; xy yy yz; xz yz zz] with xy = -int x y dm is that of a body when its principal moments are not
   negative and none exceeds the sum of the two others.
*/
#include "model/modelimpl.h"
#include <squeal/options.h>
#include "base/algebra/vec3.h"

#define AXES_PARALLEL    1e-6 /* sine of the angle between axis 1 and 2 below which they are one */
#define INERTIA_ROUNDING 1e-9 /* of the largest principal moment */
#define MAX_OPTION       256

/* Whether there is anything but zeros */
static PetscBool JointIsGiven(PetscInt n, const PetscReal value[])
{
  for (PetscInt i = 0; i < n; i++)
    if (value[i] != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The axes of a bushing, orthonormal rows */
static PetscErrorCode JointFrame(MPI_Comm comm, Joint *joint)
{
  PetscReal *const x = joint->frame, *const y = &joint->frame[3];
  int least = 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < 9; i++) joint->frame[i] = i % 4 == 0;
  PetscCheck(joint->has_axis[0] || !joint->has_axis[1], comm, PETSC_ERR_USER_INPUT,
             "-%s_axis_2 needs -%s_axis_1, the direction of its x", joint->name, joint->name);
  if (!joint->has_axis[0]) PetscFunctionReturn(0);
  PetscCall(PetscArraycpy(x, joint->axis[0], 3));
  PetscCheck(Vec3Normalise(x) > 0, comm, PETSC_ERR_USER_INPUT, "-%s_axis_1 0,0,0 is no direction", joint->name);
  for (int d = 1; d < 3; d++)
    if (PetscAbsReal(x[d]) < PetscAbsReal(x[least])) least = d;
  for (int d = 0; d < 3; d++) y[d] = joint->has_axis[1] ? joint->axis[1][d] : d == least;
  PetscCheck(Vec3Normalise(y) > 0, comm, PETSC_ERR_USER_INPUT, "-%s_axis_2 0,0,0 is no direction", joint->name);
  {
    const PetscReal along = Vec3Dot(x, y);

    for (int d = 0; d < 3; d++) y[d] -= along * x[d];
  }
  PetscCheck(Vec3Normalise(y) > AXES_PARALLEL, comm, PETSC_ERR_USER_INPUT, "-%s_axis_1 and -%s_axis_2 are parallel",
             joint->name, joint->name);
  Vec3Cross(x, y, &joint->frame[6]);
  PetscFunctionReturn(0);
}

PetscErrorCode JointCheck(MPI_Comm comm, void *owner, void *record)
{
  Joint *joint = record;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCall(JointFrame(comm, joint));
  PetscCheck(!joint->has_at_b || joint->set[1][0], comm, PETSC_ERR_USER_INPUT,
             "-%s_at_b does nothing without -%s_b, the other side", joint->name, joint->name);
  PetscCheck(strcmp(joint->set[0], joint->set[1]), comm, PETSC_ERR_USER_INPUT,
             "-%s_a and -%s_b both name %s: a bushing joins two sets, or one and the ground", joint->name, joint->name,
             joint->set[0]);
  PetscCheck(JointIsGiven(6, joint->stiffness) || JointIsGiven(6, joint->viscosity), comm, PETSC_ERR_USER_INPUT,
             "bushing %s does nothing: give -%s_stiffness, -%s_turn_stiffness, -%s_viscosity or -%s_turn_viscosity",
             joint->name, joint->name, joint->name, joint->name, joint->name);
  PetscFunctionReturn(0);
}

PetscErrorCode PointCheck(MPI_Comm comm, void *owner, void *record)
{
  Joint         *joint = record;
  const PetscInt n     = joint->n_inertia;
  PetscReal      principal[3], axes[9], *J = joint->inertia;

  PetscFunctionBeginUser;
  (void)owner;
  joint->is_point = PETSC_TRUE;
  PetscCall(JointFrame(comm, joint));
  if (!joint->set[1]) PetscCall(PetscStrallocpy("", &joint->set[1]));
  PetscCheck(!n || n == 3 || n == 6, comm, PETSC_ERR_USER_INPUT,
             "-%s_inertia has %" PetscInt_FMT " values; give xx,yy,zz or xx,yy,zz,xy,xz,yz (kg m^2)", joint->name, n);
  PetscCall(InertiaPrincipal(J, principal, axes));
  PetscCheck(principal[0] >= -INERTIA_ROUNDING * PetscAbsReal(principal[2]), comm, PETSC_ERR_USER_INPUT,
             "-%s_inertia: no body has the principal moments %.6g, %.6g, %.6g kg m^2, since one is negative",
             joint->name, (double)principal[0], (double)principal[1], (double)principal[2]);
  PetscCheck(principal[2] - principal[1] - principal[0] <= INERTIA_ROUNDING * principal[2], comm, PETSC_ERR_USER_INPUT,
             "-%s_inertia: no body has the principal moments %.6g, %.6g, %.6g kg m^2, since one exceeds the sum of the "
             "two others",
             joint->name, (double)principal[0], (double)principal[1], (double)principal[2]);
  PetscFunctionReturn(0);
}

/* The option that asks for its rotations, empty for none, and whether anything acts on it at all */
static PetscErrorCode JointAsked(Model model, const Joint *joint, char turns[MAX_OPTION], PetscBool *any)
{
  const ModelScene *s    = &model->scene;
  const char       *what = joint->rigid                            ? "join rigid"
                           : JointIsGiven(3, &joint->stiffness[3]) ? "turn_stiffness"
                           : JointIsGiven(3, &joint->viscosity[3]) ? "turn_viscosity"
                           : JointIsGiven(6, joint->inertia)       ? "inertia"
                                                                   : NULL;

  PetscFunctionBeginUser;
  turns[0] = '\0';
  if (what) PetscCall(PetscSNPrintf(turns, MAX_OPTION, "-%s_%s", joint->name, what));
  *any = what || JointIsGiven(3, joint->stiffness) || JointIsGiven(3, joint->viscosity) || joint->mass > 0;
  if (joint->is_point && model->has_superelements) *any = PETSC_TRUE; /* one may be joined to it */
  for (PetscInt i = 0; i < s->n_loads; i++) {
    if (!s->loads[i].on_point || &s->points[s->loads[i].point] != joint) continue;
    *any = PETSC_TRUE;
    if (!turns[0] && JointIsGiven(3, s->loads[i].moment))
      PetscCall(PetscSNPrintf(turns, MAX_OPTION, "-%s_moment", s->loads[i].name));
  }
  PetscFunctionReturn(0);
}

/* Whether any of its loads, or its weight, is a force that supports carry */
static PetscBool JointIsLoaded(const ModelScene *s, const Joint *joint)
{
  for (PetscInt i = 0; i < s->n_loads; i++)
    if (s->loads[i].on_point && &s->points[s->loads[i].point] == joint) return PETSC_TRUE;
  return joint->mass > 0 && JointIsGiven(3, s->gravity) ? PETSC_TRUE : PETSC_FALSE;
}

/* Raises an error where supports hold all that the motions in question are means of. Displacements that -motions
   prescribe, if not as zero, are no unknowns either; the joint then has a force */
static PetscErrorCode JointCheckFree(Model model, const Joint *joint)
{
  const ModelMean *mean = &joint->mean;
  PetscBool        asked[6], acts = joint->rigid; /* operators/points/rigid.c refuses rigid sets that are held */

  PetscFunctionBeginUser;
  for (int k = 0; k < 6; k++)
    asked[k] = joint->stiffness[k] > 0 || joint->viscosity[k] > 0 || (k < 3 && joint->mass > 0) ||
                   (k >= 3 && JointIsGiven(6, joint->inertia))
                 ? PETSC_TRUE
                 : PETSC_FALSE;
  for (PetscInt i = 0; i < 3 * mean->n; i++) {
    const PetscInt at = 3 * mean->vertex[i / 3] + i % 3;

    if (model->mesh.unknown[at] < 0 && (!model->mesh.prescribed || model->mesh.prescribed[at] == 0)) continue;
    for (int k = 0; k < 6; k++)
      if (asked[k] && mean->b[6 * i + k] != 0) acts = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &acts, 1, MPIU_BOOL, MPI_LOR, model->comm));
  PetscCheck(acts || JointIsLoaded(&model->scene, joint) || (joint->is_point && model->has_superelements), model->comm,
             PETSC_ERR_USER_INPUT,
             "%s %s does nothing: supports hold all of %s%s%s in its directions; name a set that is free to move",
             joint->is_point ? "point" : "bushing", joint->name, joint->set[0], joint->set[1][0] ? " and " : "",
             joint->set[1]);
  PetscFunctionReturn(0);
}

/* Motions in the axes of the joint, in the place of those of space */
static void JointTurn(Joint *joint)
{
  for (PetscInt i = 0; i < 6 * joint->mean.n; i++) {
    PetscReal *q = &joint->mean.b[3 * i], turned[3];

    for (int k = 0; k < 3; k++) turned[k] = Vec3Dot(&joint->frame[3 * k], q);
    for (int k = 0; k < 3; k++) q[k] = turned[k];
  }
}

/* The place and the six motions of one joint */
static PetscErrorCode JointSetUp(Model model, Joint *joint)
{
  const PetscInt n = joint->set[1][0] ? 2 : 1;
  ModelMeanWish  wish[2];
  PetscReal      middle[3];
  PetscBool      any;
  char           turns[MAX_OPTION];

  PetscFunctionBeginUser;
  PetscCall(JointAsked(model, joint, turns, &any));
  PetscCheck(
    any, model->comm, PETSC_ERR_USER_INPUT,
    "point %s does nothing: give -%s_mass, -%s_inertia, -%s_stiffness, -%s_viscosity, -%s_join rigid, or a load "
    "that acts on it",
    joint->name, joint->name, joint->name, joint->name, joint->name, joint->name);
  for (PetscInt k = 0; k < n; k++) {
    wish[k] = (ModelMeanWish){joint->name, joint->is_point ? "set" : k ? "b" : "a",       joint->set[k], turns,
                              k ? -1 : 1,  k && joint->has_at_b ? joint->at_b : joint->at};
    if (joint->has_at) continue;
    PetscCall(MeanFindMiddle(model, &wish[k], middle, NULL));
    for (int d = 0; d < 3; d++) joint->at[d] += middle[d] / (PetscReal)n;
  }
  PetscCall(MeanCreate(model, n, wish, &joint->mean));
  JointTurn(joint);
  PetscCall(JointCheckFree(model, joint));
  PetscFunctionReturn(0);
}

PetscErrorCode JointsSetUp(Model model)
{
  ModelScene *s = &model->scene;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < s->n_joints; i++) PetscCall(JointSetUp(model, &s->joints[i]));
  for (PetscInt i = 0; i < s->n_points; i++) PetscCall(JointSetUp(model, &s->points[i]));
  PetscFunctionReturn(0);
}

PetscErrorCode JointsDestroy(PetscInt n, Joint joint[])
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) PetscCall(MeanDestroy(&joint[i].mean));
  PetscFunctionReturn(0);
}

PetscErrorCode JointFindPoint(Model model, const char load[], const char name[], PetscInt *index)
{
  const ModelScene *s          = &model->scene;
  char              valid[512] = "";

  PetscFunctionBeginUser;
  *index = -1;
  for (PetscInt i = 0; i < s->n_points; i++) {
    if (!strcmp(s->points[i].name, name)) *index = i;
    PetscCall(OptionsTextAppend(valid, i ? ", " : "", sizeof(valid)));
    PetscCall(OptionsTextAppend(valid, s->points[i].name, sizeof(valid)));
  }
  PetscCheck(*index >= 0, model->comm, PETSC_ERR_USER_INPUT, "-%s_point %s is none of the -points: %s", load, name,
             valid[0] ? valid : "there are none");
  PetscFunctionReturn(0);
}

/* A line of three values where one is not zero */
static PetscErrorCode JointViewThree(Model model, const char what[], const PetscReal v[3], const char unit[],
                                     PetscViewer viewer)
{
  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(model, unit, &unit));
  if (JointIsGiven(3, v))
    PetscCall(
      PetscViewerASCIIPrintf(viewer, ", %s %.6g, %.6g, %.6g %s", what, (double)v[0], (double)v[1], (double)v[2], unit));
  PetscFunctionReturn(0);
}

PetscErrorCode JointView(Model model, const Joint *j, PetscViewer viewer)
{
  const char *metre, *kilogram;

  PetscFunctionBeginUser;
  PetscCall(ModelGetUnit(model, "m", &metre));
  PetscCall(ModelGetUnit(model, "kg", &kilogram));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  %s %s on %s%s%s at %.6g, %.6g, %.6g %s",
                                   j->is_point ? "point" : "bushing", j->name, j->set[0], j->is_point ? "" : " and ",
                                   j->is_point    ? ""
                                   : j->set[1][0] ? j->set[1]
                                                  : "the ground",
                                   (double)j->at[0], (double)j->at[1], (double)j->at[2], metre));
  if (j->rigid) PetscCall(PetscViewerASCIIPrintf(viewer, ", joined rigidly"));
  if (j->mass > 0) PetscCall(PetscViewerASCIIPrintf(viewer, ", mass %.6g %s", (double)j->mass, kilogram));
  PetscCall(JointViewThree(model, "inertia", j->inertia, "kg m^2", viewer));
  PetscCall(JointViewThree(model, "stiffness", j->stiffness, "N/m", viewer));
  PetscCall(JointViewThree(model, "turn stiffness", &j->stiffness[3], "N m/rad", viewer));
  PetscCall(JointViewThree(model, "viscosity", j->viscosity, "N s/m", viewer));
  PetscCall(JointViewThree(model, "turn viscosity", &j->viscosity[3], "N m s/rad", viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(0);
}
