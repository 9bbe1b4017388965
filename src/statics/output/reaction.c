/*
   Who carries the loads: reactions of supports, motions and springs, loads, and contact forces. At a held direction of
   a node

      reaction = sum K_e u_e + k u - load - contact force,

   u = d where a motion prescribes it, and a spring pulls with -k u; forces of bushings, points and superelements are
   among K_e u_e. What is left at nodes that ties make follow others acts on these.
   Loads include the weight. In equilibrium reactions, springs, bushings to the ground, points, superelements and loads
   sum to zero; reactions.csv lists them all, and what passes through the cuts of bolts.
*/
#include "statics/staticsimpl.h"

/* Internal forces minus loads and contact forces at all local nodes, three values each, N: 0 at free nodes in
   equilibrium, the reaction at held ones. Forces of followers are passed on last, with their loads and contact
   forces. */
static PetscErrorCode ReactionUnbalance(Statics s, Vec *local)
{
  const Stage *stage = StagesGet(s, s->stage);
  PetscReal    weight[3], size, *prescribed;
  Vec          part;

  PetscFunctionBeginUser;
  PetscCall(StageGetMotions(s->model, stage, &prescribed));
  PetscCall(ModelCreateNodal(s->model, local));
  PetscCall(ModelCreateNodal(s->model, &part));
  PetscCall(OperatorsInternalForces(s->operators, s->p, s->u, *local));
  PetscCall(OperatorsPrescribedForces(s->operators, s->p, prescribed, part));
  PetscCall(PetscFree(prescribed));
  PetscCall(VecAXPY(*local, 1, part));
  PetscCall(ContactNodalForces(s->contact, s->state, part));
  PetscCall(VecAXPY(*local, -1, part));
  PetscCall(VecSet(part, 0));
  PetscCall(OperatorsAddLoads(s->operators, s->p, stage->share, part, &size));
  PetscCall(OperatorsAddWeight(s->operators, s->p, part, weight));
  PetscCall(VecAXPY(*local, -1, part));
  PetscCall(VecDestroy(&part));
  PetscCall(ContactPassForces(s->contact, *local));
  PetscFunctionReturn(0);
}

/* Sum of a local vector over the nodes of a set, each once, in some directions; what was summed is set to zero, so
   that a direction that two supports hold counts for the first */
static PetscErrorCode ReactionSum(Model model, const char set[], const PetscBool direction[3], Vec local,
                                  PetscReal sum[3])
{
  PetscScalar *value;
  PetscInt     n, *v;
  MPI_Comm     comm;

  PetscFunctionBeginUser;
  PetscCall(ModelGetComm(model, &comm));
  PetscCall(ModelGetOwnedNodes(model, set, &n, &v));
  PetscCall(VecGetArray(local, &value));
  for (int d = 0; d < 3; d++) {
    sum[d] = 0;
    for (PetscInt i = 0; i < n && direction[d]; i++) {
      sum[d] += PetscRealPart(value[3 * v[i] + d]);
      value[3 * v[i] + d] = 0;
    }
  }
  PetscCall(VecRestoreArray(local, &value));
  PetscCall(PetscFree(v));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, comm));
  PetscFunctionReturn(0);
}

/* Adds one to those of the state; NULL for what is no contact */
static PetscErrorCode ReactionAdd(Statics s, const char name[], const char kind[], const PetscReal force[3],
                                  const PetscInt n[CONTACT_N_STATUS])
{
  Reaction *r;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(s->n_reactions + 1) * sizeof(*s->reaction), &s->reaction));
  r  = &s->reaction[s->n_reactions++];
  *r = (Reaction){.stage = s->stage, .name = name, .kind = kind};
  PetscCall(PetscArraycpy(r->force, force, 3));
  if (n) PetscCall(PetscArraycpy(r->n, n, CONTACT_N_STATUS));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsCreateDisplacements(Statics s, Vec *local)
{
  PetscScalar *nodal;
  PetscReal   *prescribed;
  PetscInt     n;

  PetscFunctionBeginUser;
  PetscCall(StageGetMotions(s->model, StagesGet(s, s->stage), &prescribed));
  PetscCall(ModelCreateNodal(s->model, local));
  PetscCall(VecGetLocalSize(*local, &n));
  PetscCall(VecGetArray(*local, &nodal));
  PetscCall(ModelGetNodal(s->model, s->u, nodal));
  for (PetscInt i = 0; i < n && prescribed; i++) nodal[i] += prescribed[i];
  PetscCall(VecRestoreArray(*local, &nodal));
  PetscCall(PetscFree(prescribed));
  PetscFunctionReturn(0);
}

PetscErrorCode BoltGet(Statics s, PetscInt i, OperatorsBolt *bolt)
{
  const PetscScalar *u;
  Vec                displacement;

  PetscFunctionBeginUser;
  PetscCall(StaticsCreateDisplacements(s, &displacement));
  PetscCall(VecGetArrayRead(displacement, &u));
  PetscCall(OperatorsGetBolt(s->operators, s->p, i, StagesGet(s, s->stage)->share[i], u, bolt));
  PetscCall(VecRestoreArrayRead(displacement, &u));
  PetscCall(VecDestroy(&displacement));
  PetscFunctionReturn(0);
}

/* Springs pull with their present stiffness: the parameters are named after the list, one for all directions or one for
   each */
static PetscErrorCode ReactionStiffness(Statics s, const Grounded *g, PetscReal stiffness[3])
{
  const OperatorsParameter *parameters;
  PetscInt                  n;

  PetscFunctionBeginUser;
  PetscCall(OperatorsGetParameters(s->operators, &n, &parameters));
  for (int d = 0; d < 3; d++) {
    char all[192], one[192];

    stiffness[d] = 0;
    PetscCall(PetscSNPrintf(all, sizeof(all), "%s_%s", g->name, g->quantity));
    PetscCall(PetscSNPrintf(one, sizeof(one), "%s_%s_%c", g->name, g->quantity, "xyz"[d]));
    for (PetscInt i = 0; i < n && g->value[d] != 0; i++)
      if (!strcmp(parameters[i].name, all) || !strcmp(parameters[i].name, one)) stiffness[d] = s->p[i];
  }
  PetscFunctionReturn(0);
}

/* k u of one list of springs at all local nodes, N; the caller destroys the vector */
static PetscErrorCode ReactionCreateSpring(Statics s, const Grounded *g, Vec displacement, Vec *forces)
{
  const PetscReal *u;
  PetscReal        stiffness[3], *f;
  PetscInt         n;

  PetscFunctionBeginUser;
  PetscCall(ReactionStiffness(s, g, stiffness));
  PetscCall(ModelCreateShares(s->model, g->name, g->set, g->spread, forces));
  PetscCall(VecGetLocalSize(*forces, &n));
  PetscCall(VecGetArrayRead(displacement, &u));
  PetscCall(VecGetArray(*forces, &f));
  /* backwards: the share of a node stands in its first value, which is read for all three and overwritten last */
  for (PetscInt i = n - 1; i >= 0; i--) f[i] = f[i - i % 3] * stiffness[i % 3] * u[i];
  PetscCall(VecRestoreArray(*forces, &f));
  PetscCall(VecRestoreArrayRead(displacement, &u));
  PetscFunctionReturn(0);
}

/* Rows of bushings to the ground and points with stiffness, and of bushings between two sets: -k q, on a of the two */
static PetscErrorCode ReactionsFindJoints(Statics s, Vec displacement)
{
  const ModelScene *scene;
  const PetscReal  *u;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  PetscCall(VecGetArrayRead(displacement, &u));
  for (PetscInt i = 0; i < scene->n_joints + scene->n_points; i++) {
    const Joint *joint = i < scene->n_joints ? &scene->joints[i] : &scene->points[i - scene->n_joints];
    PetscReal    q[6], k[6], c[6], m, force[3];

    PetscCall(OperatorsGetJoint(s->operators, s->p, i, k, c, &m));
    if (k[0] + k[1] + k[2] + k[3] + k[4] + k[5] == 0) continue;
    PetscCall(ModelGetMeanMotion(s->model, &joint->mean, u, q));
    for (int d = 0; d < 3; d++) q[d] *= -k[d], force[d] = 0;
    for (int d = 0; d < 9; d++) force[d % 3] += joint->frame[d] * q[d / 3];
    PetscCall(ReactionAdd(s, joint->name,
                          joint->is_point    ? "point"
                          : joint->set[1][0] ? "bushing on a"
                                             : "bushing",
                          force, NULL));
  }
  PetscCall(VecRestoreArrayRead(displacement, &u));
  PetscFunctionReturn(0);
}

/* Rows of superelements: what they exert on the mesh */
static PetscErrorCode ReactionsFindSuperelements(Statics s, Vec displacement)
{
  const PetscReal *u;
  const Mesh      *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(s->model, &mesh));
  PetscCall(VecGetArrayRead(displacement, &u));
  for (PetscInt k = 0; k < OperatorsCountSuperelements(s->operators); k++) {
    const char *name;
    PetscReal   force[3];

    PetscCall(OperatorsGetPartName(s->operators, mesh->n_parts + k, &name));
    PetscCall(OperatorsGetSuperelementForce(s->operators, s->p, k, s->u, u, force));
    PetscCall(ReactionAdd(s, name, "superelement", force, NULL));
  }
  PetscCall(VecRestoreArrayRead(displacement, &u));
  PetscFunctionReturn(0);
}

/* Rows of supports, motions and springs */
static PetscErrorCode ReactionsFindHolders(Statics s)
{
  const PetscBool   all[3] = {PETSC_TRUE, PETSC_TRUE, PETSC_TRUE};
  const ModelScene *scene;
  PetscReal         force[3];
  Vec               unbalance, u, spring;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  PetscCall(ReactionUnbalance(s, &unbalance));
  PetscCall(StaticsCreateDisplacements(s, &u));
  for (PetscInt i = 0; i < scene->n_springs; i++) { /* at what motions hold; elsewhere supports hold u = 0 */
    PetscCall(ReactionCreateSpring(s, &scene->springs[i], u, &spring));
    PetscCall(VecAXPY(unbalance, 1, spring));
    PetscCall(VecDestroy(&spring));
  }
  for (PetscInt i = 0; i < scene->n_supports; i++) {
    PetscCall(ReactionSum(s->model, scene->supports[i].set, scene->supports[i].fix, unbalance, force));
    PetscCall(ReactionAdd(s, scene->supports[i].name, "support", force, NULL));
  }
  for (PetscInt i = 0; i < scene->n_motions; i++) {
    PetscCall(ReactionSum(s->model, scene->motions[i].set, scene->motions[i].direction, unbalance, force));
    PetscCall(ReactionAdd(s, scene->motions[i].name, "motion", force, NULL));
  }
  for (PetscInt i = 0; i < scene->n_springs; i++) {
    PetscCall(ReactionCreateSpring(s, &scene->springs[i], u, &spring));
    PetscCall(VecScale(spring, -1));
    PetscCall(ReactionSum(s->model, scene->springs[i].set, all, spring, force));
    PetscCall(VecDestroy(&spring));
    PetscCall(ReactionAdd(s, scene->springs[i].name, "spring", force, NULL));
  }
  PetscCall(ReactionsFindJoints(s, u));
  PetscCall(ReactionsFindSuperelements(s, u));
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&unbalance));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReactionFindWeight(Statics s)
{
  PetscReal weight[3];
  Vec       nodal;

  PetscFunctionBeginUser;
  PetscCall(ModelCreateNodal(s->model, &nodal));
  PetscCall(OperatorsAddWeight(s->operators, s->p, nodal, weight));
  PetscCall(VecDestroy(&nodal));
  PetscCall(ReactionAdd(s, "gravity", "weight", weight, NULL));
  PetscFunctionReturn(0);
}

/* What the other side of the cut exerts on the part of a bolt */
static PetscErrorCode ReactionFindBolt(Statics s, PetscInt i)
{
  const ModelScene *scene;
  OperatorsBolt     bolt;
  PetscReal         force[3];

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  PetscCall(BoltGet(s, i, &bolt));
  for (int d = 0; d < 3; d++) force[d] = bolt.tension * scene->loads[i].axis[d];
  PetscCall(ReactionAdd(s, scene->loads[i].name, "bolt on its part", force, NULL));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsFindReactions(Statics s)
{
  const Stage      *stage   = StagesGet(s, s->stage);
  const PetscReal   none[3] = {0, 0, 0};
  const ModelScene *scene;

  PetscFunctionBeginUser;
  PetscCall(ModelGetScene(s->model, &scene));
  PetscCall(ReactionsFindHolders(s));
  for (PetscInt i = 0; i < scene->n_loads; i++) {
    const Load *load = &scene->loads[i];

    if (load->is_bolt)
      PetscCall(ReactionFindBolt(s, i));
    else
      PetscCall(ReactionAdd(s, load->name, "load", stage->load[i] > 0 ? load->force : none, NULL));
  }
  if (ModelHasGravity(s->model)) PetscCall(ReactionFindWeight(s));
  for (PetscInt i = 0; i < s->rows.n_interfaces; i++)
    PetscCall(ReactionAdd(s, s->rows.interface[i].name, "contact on master", s->resultant[i].force, s->resultant[i].n));
  PetscFunctionReturn(0);
}

PetscErrorCode StaticsWriteReactions(Statics s, Results results)
{
  ResultsTable table;

  PetscFunctionBeginUser;
  if (!s->n_reactions) PetscCall(StaticsFindReactions(s));
  PetscCall(ResultsTableOpen(results, "reactions", "name,kind,force_x_n,force_y_n,force_z_n", &table));
  for (PetscInt i = 0; i < s->n_reactions; i++) {
    const Reaction *r = &s->reaction[i];

    if (r->stage == s->stage)
      PetscCall(ResultsTableRow(table, "%s,%s,%.15g,%.15g,%.15g", r->name, r->kind, (double)r->force[0],
                                (double)r->force[1], (double)r->force[2]));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}
