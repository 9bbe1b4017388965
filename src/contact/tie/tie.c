/*
   Ties: bodies whose meshes do not match, glued. Every node of the slave follows one point x(xi) of the master, its
   foot, in all three directions,

      u_s = sum_i w_i(xi) u_i + omega x (x_s - x(xi)).

   The weights w_i are those of the facet, of second order too. omega is the turning of the facet there
   (kernels/contact/arm.h). A gap between the surfaces is a rigid arm, which turns with the master: rigid motions of
   both bodies are exact. Forces on the slave act on the nodes of the facet by the transpose.

   At its foot the normal of the master leads to the node. It is interpolated between the nodes of the surface (foot.c).
   Where no normal does, the foot is the nearest point, beyond the border one on it. -X_distance is the longest arm.

   Where flat surfaces touch, displacements that are linear in x obey the tie. Uniform stress along the surface is exact
   on any two meshes. Traction on it is where the slave's mesh refines the master's: sum_s w_i(x_s) int N_s dA = int N_i
   dA. Elsewhere its total is exact, and stress beside the surface is off by an amount that vanishes with the mesh. Let
   the finer of the two be the slave.

   Nodes of both surfaces need no equation. A direction in which a support holds the slave needs none where it holds the
   nodes of the facet as well.
*/
#include "tie.h"
#include "kernels/contact/arm.h"

/* of the size of a facet: the largest distance where none is given; gaps of meshes of one curved surface, whose
   sagitta is h^2 / (8 R), are below it */
#define TIE_SHARE 0.05
/* of that size: rounding of the places, no gap */
#define TIE_TOUCHES 1e-9

PetscErrorCode TieCheckNames(MPI_Comm comm, void *owner, void *record)
{
  const ContactTie *tie = record;

  PetscFunctionBeginUser;
  (void)owner;
  PetscCheck(strcmp(tie->slave, tie->master), comm, PETSC_ERR_USER_INPUT,
             "-%s_surfaces names %s twice: a tie joins two surfaces", tie->name, tie->slave);
  PetscFunctionReturn(0);
}

/* Nodes that are too far off: how many of this rank, and the farthest, m */
typedef struct {
  PetscInt  n;
  PetscReal distance, x[3];
} TieFar;

/* Takes a place that is worse than those before */
static void FailureTake(PetscReal value, const PetscReal x[3], PetscReal *worst, PetscReal where[3])
{
  if (value <= *worst) return;
  *worst = value;
  for (int d = 0; d < 3; d++) where[d] = x[d];
}

PetscReal FootGetArm(const ContactFacet *facet, const ContactFoot *foot, const PetscReal x[3], PetscReal arm[3])
{
  PetscReal w[CONTACT_MAX_MASTER], point[3], length;

  FacetWeights(facet->n, foot->natural, w);
  FacetSum(facet->n, w, (const double(*)[3])facet->x, point);
  for (int d = 0; d < 3; d++) arm[d] = x[d] - point[d];
  length = Vec3Length(arm);
  if (length < TIE_TOUCHES * facet->size) arm[0] = arm[1] = arm[2] = 0;
  return length;
}

PetscInt LinkSetMaster(const ContactSurface *surface, const ContactFoot *foot, const PetscReal arm[3],
                       ContactLinkNode master[])
{
  const ContactFacet *facet = &surface->facet[foot->facet];
  PetscReal           w[CONTACT_MAX_MASTER], A[CONTACT_MAX_MASTER][9];
  PetscInt            n = 0;

  FacetWeights(facet->n, foot->natural, w);
  FacetArm(facet->n, (const double(*)[3])facet->x, foot->natural, arm, A);
  for (int i = 0; i < facet->n; i++) {
    PetscReal size = 0;

    for (int k = 0; k < 9; k++) size += PetscAbsReal(A[i][k]);
    if (size == 0) continue;
    master[n] = (ContactLinkNode){.number = surface->vertex[facet->node[i]], .weight = w[i]};
    for (int d = 0; d < 3; d++) master[n].unknown[d] = facet->unknowns[i][d];
    for (int k = 0; k < 9; k++) master[n].follow[k] = A[i][k];
    n++;
  }
  return n;
}

/* Whether it is a node of both surfaces, which needs no link */
static PetscBool LinkIsCommon(const ContactLink *link)
{
  for (PetscInt i = 0; i < link->n_master; i++)
    if (link->master[i].number == link->vertex && PetscAbsReal(link->master[i].weight - 1) < 1e-9) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Drops the directions in which supports hold slave and master: rows of A_i of these become 0. True where a support
   holds the slave alone, in which case u_s = 0 and sum_i w_i u_i = 0 would be an equation on the master, which no
   elimination of slaves makes. */
static PetscBool LinkDropHeld(const ContactLink *link, ContactLinkNode master[])
{
  PetscBool alone = PETSC_FALSE;

  for (int d = 0; d < 3; d++) {
    if (link->slave[d] >= 0) continue;
    for (PetscInt i = 0; i < link->n_master; i++) {
      if (master[i].weight != 0 && master[i].unknown[d] >= 0) alone = PETSC_TRUE;
      for (int e = 0; e < 3; e++) master[i].follow[3 * d + e] = 0;
    }
  }
  return alone;
}

/* A tie as its links are made: what it has on this rank, and what fails */
typedef struct {
  const Mesh    *mesh;
  ContactTie     tie; /* with the counts of this rank */
  ContactSurface master;
  TieFar         far, beside;     /* over the master; beyond its border, which mortar leaves out */
  PetscReal      held, held_x[3]; /* 1 where a support holds the slave alone, and there, m */
} TieWork;

PetscReal TieReach(PetscReal distance, const ContactFacet *facet)
{
  return distance > 0 ? distance : TIE_SHARE * facet->size;
}

/* Counts a node that lies beyond the border of the master: its arm is not along the normal */
static void TieLookBeyond(const ContactFacet *facet, const ContactFoot *foot, const PetscReal arm[3], ContactTie *tie)
{
  PetscReal w[CONTACT_MAX_MASTER], e[3][3], beyond;

  (void)ContactBasis(facet, foot->natural, arm, w, e);
  beyond = PetscAbsReal(Vec3Dot(e[1], arm));
  if (beyond <= TIE_SHARE * facet->size) return;
  tie->n_beyond++, tie->beyond = PetscMax(tie->beyond, beyond);
}

/* The link of local node v, with room for what it follows; none for one that is too far off, or common to both */
static void LinkMake(TieWork *work, PetscInt v, ContactLink *link, ContactLinkNode master[])
{
  ContactTie         *tie = &work->tie;
  const ContactFacet *facet;
  ContactFoot         foot;
  PetscReal           arm[3];

  link->node     = v;
  link->vertex   = work->mesh->number[v];
  link->n_master = 0;
  link->master   = master;
  for (int d = 0; d < 3; d++) {
    link->x[d]     = work->mesh->x[3 * v + d];
    link->slave[d] = work->mesh->unknown[3 * v + d];
  }
  ContactFootFind(&work->master, link->x, &foot);
  facet = foot.facet < 0 ? NULL : &work->master.facet[foot.facet];
  if (facet) foot.distance = FootGetArm(facet, &foot, link->x, arm);
  if (!facet || foot.distance > TieReach(tie->distance, facet)) {
    TieFar *far = facet && foot.across > 0 ? &work->beside : &work->far;

    far->n++;
    FailureTake(foot.distance, link->x, &far->distance, far->x);
    return;
  }
  link->n_master = LinkSetMaster(&work->master, &foot, arm, master);
  if (LinkIsCommon(link)) {
    tie->n_common++;
    link->n_master = 0;
    return;
  }
  tie->n++;
  tie->offset = PetscMax(tie->offset, foot.distance);
  TieLookBeyond(facet, &foot, arm, tie);
  FailureTake(LinkDropHeld(link, master) ? 1 : 0, link->x, &work->held, work->held_x);
}

/* Raises the error for nodes that are too far off, from counts of all ranks */
static PetscErrorCode TieCheckFar(MPI_Comm comm, const ContactTie *tie, TieFar *far)
{
  char words[64] = "(5 % of a facet)", node[256] = "";

  PetscFunctionBeginUser;
  if (tie->n_far == 0 || (tie->free && !tie->mortar && tie->n + tie->n_common)) PetscFunctionReturn(0);
  if (tie->distance > 0) PetscCall(PetscSNPrintf(words, sizeof(words), "%.6g m", (double)tie->distance));
  if (tie->mortar) PetscCall(PetscSNPrintf(node, sizeof(node), "-%s_discretization node with ", tie->name));
  PetscCall(ContactShareWorst(comm, &far->distance, far->x));
  SETERRQ(comm, PETSC_ERR_USER_INPUT,
          "tie %s: %" PetscInt_FMT " of %" PetscInt_FMT
          " nodes of %s are farther from %s than -%s_distance %s; the one at %.6g, %.6g, %.6g m is %.6g m away; give a "
          "larger one, a set of the nodes that touch, or %s-%s_far free",
          tie->name, tie->n_far, tie->n_slaves, tie->slave, tie->master, tie->name, words, (double)far->x[0],
          (double)far->x[1], (double)far->x[2], (double)far->distance, node, tie->name);
}

/* Raises the other errors of one tie, whose counts are those of all ranks */
static PetscErrorCode TieCheck(MPI_Comm comm, const ContactTie *tie, TieWork *work)
{
  PetscFunctionBeginUser;
  PetscCall(ContactShareWorst(comm, &work->held, work->held_x));
  PetscCheck(tie->n || !tie->mortar || tie->n_common, comm, PETSC_ERR_USER_INPUT,
             "tie %s glues nothing: no face of %s lies over %s; give two of -%s_surfaces that do", tie->name,
             tie->slave, tie->master, tie->name);
  PetscCheck(tie->n || !tie->n_common, comm, PETSC_ERR_USER_INPUT,
             "tie %s glues nothing: %" PetscInt_FMT
             " nodes of %s are nodes of %s as well; leave it out, or give each body "
             "nodes of its own there",
             tie->name, tie->n_common, tie->slave, tie->master);
  PetscCheck(work->held == 0, comm, PETSC_ERR_USER_INPUT,
             "tie %s: a support or motion holds the node of %s at %.6g, %.6g, %.6g m in a direction in which the nodes "
             "of %s beside it are free: let it hold both, or swap -%s_surfaces",
             tie->name, tie->slave, (double)work->held_x[0], (double)work->held_x[1], (double)work->held_x[2],
             tie->master, tie->name);
  PetscFunctionReturn(0);
}

/* Raises an error for nodes that a motion moves: what follows them would not be a linear function of the unknowns */
static PetscErrorCode TieCheckMotions(Contact contact, const ContactTie *tie, const char set[])
{
  const Mesh *mesh;
  PetscInt    n, *node, moved = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &mesh));
  PetscCall(ModelGetSetNodes(contact->model, set, &n, &node));
  for (PetscInt i = 0; i < 3 * n && mesh->prescribed; i++)
    if (mesh->prescribed[3 * node[i / 3] + i % 3] != 0) moved = 1;
  PetscCall(PetscFree(node));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &moved, 1, MPIU_INT, MPI_MAX, contact->comm));
  PetscCheck(!moved, contact->comm, PETSC_ERR_SUP,
             "tie %s: -motions move nodes of %s, which is not supported: move another set of that body", tie->name,
             set);
  PetscFunctionReturn(0);
}

/* Appends the links of slave nodes that this rank owns to their feet. Every rank has the whole master, so that feet
   need no exchange; errors are raised by all ranks from counts that are summed before. */
static PetscErrorCode LinksMake(Contact contact, PetscInt t, TieWork *work)
{
  PetscInt         n, *vertex;
  ContactLinkNode *master;

  PetscFunctionBeginUser;
  PetscCall(ModelGetOwnedNodes(contact->model, work->tie.slave, &n, &vertex));
  work->tie.n_slaves = n;
  PetscCall(PetscRealloc(sizeof(ContactLink) * (size_t)(contact->n_links + n), &contact->links));
  PetscCall(PetscMalloc1(CONTACT_MAX_MASTER * n, &master));
  contact->followed[t] = master;
  for (PetscInt i = 0; i < n; i++) {
    ContactLink *link = &contact->links[contact->n_links];

    link->tie = t;
    LinkMake(work, vertex[i], link, master);
    master += link->n_master;
    if (link->n_master) contact->n_links++;
  }
  PetscCall(PetscFree(vertex));
  PetscFunctionReturn(0);
}

/* Puts mortar links in the place of those from the first on */
static PetscErrorCode LinksReplace(Contact contact, PetscInt t, PetscInt first, TieWork *work)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(contact->followed[t]));
  contact->n_links = first;
  work->held       = 0;
  work->tie.n = work->tie.n_beyond = 0;
  work->tie.offset = work->tie.beyond = 0;
  PetscCall(ContactGlue(contact, t, &work->master, &work->tie, &work->held, work->held_x));
  PetscFunctionReturn(0);
}

/* What was chosen, and which nodes stay free or lie beside the master */
static PetscErrorCode TieTell(MPI_Comm comm, const ContactTie *tie)
{
  PetscFunctionBeginUser;
  if (tie->n_far)
    PetscCall(PetscFPrintf(comm, stderr,
                           "squeal: warning: tie %s: %" PetscInt_FMT " of %" PetscInt_FMT
                           " nodes of %s are too far off %s, and stay free\n",
                           tie->name, tie->n_far, tie->n_slaves, tie->slave, tie->master));
  if (tie->discretization == CONTACT_AUTO && tie->mortar)
    PetscCall(PetscPrintf(comm, "tie %s: meshes do not match: mortar\n", tie->name));
  if (tie->mortar && tie->free)
    PetscCall(PetscPrintf(comm, "note: tie %s: -%s_far free is not used by mortar\n", tie->name, tie->name));
  if (tie->n_beyond)
    PetscCall(PetscPrintf(comm,
                          "note: tie %s: %" PetscInt_FMT " of %" PetscInt_FMT " nodes lie beyond the border of %s, the "
                          "farthest %.6g m, and follow it by rigid arms; a smaller -%s_distance leaves them out\n",
                          tie->name, tie->n_beyond, tie->n, tie->master, (double)tie->beyond, tie->name));
  if (tie->n_off)
    PetscCall(PetscPrintf(comm,
                          "note: tie %s: %" PetscInt_FMT " of %" PetscInt_FMT " nodes of %s have no or little of %s "
                          "under them, and stay free\n",
                          tie->name, tie->n_off, tie->n_slaves, tie->slave, tie->master));
  PetscFunctionReturn(0);
}

/* Chooses feet or mortar: auto by whether the meshes match, which the links to feet tell, those from the first on.
   Mortar needs a slave that is a surface. */
static PetscErrorCode TieChoose(Contact contact, PetscInt t, PetscInt first, const ContactSurface *master)
{
  ContactTie *tie   = &contact->ties[t];
  PetscBool   match = tie->discretization == CONTACT_NODE ? PETSC_TRUE : PETSC_FALSE;
  ModelFaces  faces;

  PetscFunctionBeginUser;
  if (tie->discretization == CONTACT_AUTO) PetscCall(ContactTieMatches(contact, t, first, master, &match));
  tie->mortar = match ? PETSC_FALSE : PETSC_TRUE;
  if (match) PetscFunctionReturn(0);
  PetscCall(ModelGetSetFaces(contact->model, tie->slave, &faces)); /* raises the error for one that is none */
  PetscCall(ModelFacesDestroy(&faces));
  PetscFunctionReturn(0);
}

/* The nodes that are too far off by what ties */
static void TieCountFar(PetscBool mortar, TieWork *work)
{
  work->tie.n_far = work->far.n;
  if (mortar) return;
  work->tie.n_far += work->beside.n;
  FailureTake(work->beside.distance, work->beside.x, &work->far.distance, work->far.x);
}

/* Sums what a tie has over all ranks */
static PetscErrorCode TieShare(MPI_Comm comm, const TieWork *work, ContactTie *tie)
{
  PetscFunctionBeginUser;
  /* n_slaves, n, n_common, n_far, n_beyond, n_off, then offset, beyond, stand one after the other in ContactTie */
  PetscCallMPI(MPI_Allreduce(&work->tie.n_slaves, &tie->n_slaves, 6, MPIU_INT, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(&work->tie.offset, &tie->offset, 2, MPIU_REAL, MPI_MAX, comm));
  PetscFunctionReturn(0);
}

/* Appends the links of one tie */
static PetscErrorCode TieSetUp(Contact contact, PetscInt t)
{
  ContactTie    *tie   = &contact->ties[t];
  TieWork        work  = {.tie = *tie};
  const PetscInt first = contact->n_links;

  PetscFunctionBeginUser;
  PetscCall(ModelGetMesh(contact->model, &work.mesh));
  PetscCall(ContactSurfaceCreate(contact, tie->master, &work.master));
  PetscCall(LinksMake(contact, t, &work));
  PetscCall(TieChoose(contact, t, first, &work.master));
  TieCountFar(tie->mortar, &work);
  PetscCall(TieShare(contact->comm, &work, tie));
  PetscCall(TieCheckFar(contact->comm, tie, &work.far));
  if (tie->mortar) {
    PetscCall(LinksReplace(contact, t, first, &work));
    PetscCall(TieShare(contact->comm, &work, tie));
  }
  PetscCall(ContactSurfaceDestroy(&work.master));
  PetscCall(TieCheck(contact->comm, tie, &work));
  PetscCall(TieTell(contact->comm, tie));
  PetscCall(TieCheckMotions(contact, tie, tie->slave));
  PetscCall(TieCheckMotions(contact, tie, tie->master));
  PetscFunctionReturn(0);
}

PetscErrorCode ContactSetUpTies(Contact contact)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(contact->n_ties, &contact->followed));
  for (PetscInt t = 0; t < contact->n_ties; t++) PetscCall(TieSetUp(contact, t));
  PetscFunctionReturn(0);
}
