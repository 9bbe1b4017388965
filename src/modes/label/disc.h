/* Private to modes/: the fit of a disc's displacement by harmonics and radial polynomials (see label.c) */
#pragma once

#include <petscsys.h>

#define DISC_HARMONICS   17 /* m = 0..16 */
#define DISC_POLYNOMIALS 5  /* Legendre, degree 0..4 */
#define DISC_TERMS       ((2 * DISC_HARMONICS - 1) * DISC_POLYNOMIALS)

/* Directions of the displacement; each is fitted by itself with the same terms */
enum { DISC_AXIAL, DISC_RADIAL, DISC_TANGENTIAL, N_DISC_DIRECTIONS };

/* Values that a fit has for one harmonic at a radius: cosine re, cosine im, sine re, sine im */
enum { DISC_COS_RE, DISC_COS_IM, DISC_SIN_RE, DISC_SIN_IM, N_DISC_VALUES };

#define DISC_SAMPLES 41 /* places at which profiles are read */
#define DISC_WAITING 48 /* displacements that one product takes: the basis goes through the memory once for them */

/* How the displacement of a node enters the fit */
typedef struct {
  PetscReal weight;       /* its mass, kg */
  PetscReal cosine, sine; /* of theta */
  PetscReal scale;        /* one over the root of the mass at its place */
} DiscTurned;

typedef struct _p_Disc {
  MPI_Comm    comm;
  PetscBool   has_contact;
  PetscReal   centre[3], axis[3], e1[3], e2[3]; /* e1 points to the contact */
  PetscReal   r_inner, r_outer;                 /* m */
  PetscBool   is_drum;                          /* twice as long as wide: profiles are read along the axis */
  PetscReal   range[2];                         /* of the radius, or of a drum's place along the axis, m */
  PetscReal   size;                             /* radius of gyration, m */
  int         n_harmonics;                      /* of DISC_HARMONICS, those that the mesh resolves */
  PetscInt    n_nodes, n_modes;                 /* nodes of the disc on this rank; shapes to fit */
  PetscInt   *node;                             /* their local nodes */
  PetscReal  *weight;                           /* nodal mass, kg */
  PetscInt    n_places, *place;                 /* places (s, theta) on this rank; [n_nodes] where the nodes are */
  DiscTurned *turn;                             /* [n_nodes] */
  PetscReal  *basis;                            /* [n_places][DISC_TERMS] times the root of the weight there */
  PetscReal  *gram;                             /* [DISC_TERMS][DISC_TERMS] */
  PetscReal  *rhs, *fit;    /* [n_modes][N_DISC_DIRECTIONS][2][DISC_TERMS]: right-hand sides; coefficients */
  PetscInt    n_waiting;    /* of at most DISC_WAITING displacements of shapes, m times the root of kg: */
  PetscReal  *waiting;      /* [n_waiting][n_places] */
  PetscInt   *waiting_from; /* [n_waiting] which right-hand sides they are to make */
} Disc;

/* A part that may be a disc */
typedef struct {
  PetscInt         n_vertices; /* local ones */
  const PetscReal *x, *mass;   /* [n_vertices][3] m, [n_vertices] kg */
  const PetscReal *contact;    /* centre of the contact, m; NULL without */
  const PetscBool *surface;    /* [n_vertices]: on a contact surface; NULL for none */
} DiscPart;

/* is_disc = whether two of the three principal moments of inertia agree within 5 %, so that there is an axis */
PETSC_INTERN PetscErrorCode DiscCreate(MPI_Comm comm, const DiscPart *part, Disc *disc, PetscBool *is_disc);
/* label/places.c - polar coordinates of a point, m and rad */
PETSC_INTERN void DiscPolar(const Disc *disc, const PetscReal x[3], PetscReal *r, PetscReal *theta);
/* Place along the axis from the centre, m */
PETSC_INTERN PetscReal DiscAlong(const Disc *disc, const PetscReal x[3]);
/* Radius, of a drum the place along the axis, and angle, m and rad */
PETSC_INTERN void DiscPlace(const Disc *disc, const PetscReal x[3], PetscReal *s, PetscReal *theta);
/* Which nodes are at one place, through the thickness */
PETSC_INTERN PetscErrorCode DiscFindPlaces(Disc *disc, const PetscReal x[]);
/* label/fit.c - basis and normal equations; then, for each set of shapes anew, room for their fit */
PETSC_INTERN PetscErrorCode DiscFitCreate(Disc *disc, const PetscReal x[]);
PETSC_INTERN PetscErrorCode DiscFitBegin(Disc *disc, PetscInt n_modes);
/* Takes the displacements u[re, im][local nodes][3] of a shape for its right-hand sides, u[1] = NULL for a real one;
   adds their energy on this rank, all and out of plane, to energy */
PETSC_INTERN PetscErrorCode DiscProject(Disc *disc, PetscInt mode, PetscReal *const u[2], PetscReal energy[2]);
PETSC_INTERN PetscErrorCode DiscSolve(Disc *disc);
/* Profiles of harmonic m of one mode in a direction at the radius, of a drum the place along the axis, s */
PETSC_INTERN void DiscProfile(const Disc *disc, PetscInt mode, int direction, int m, PetscReal s,
                              PetscReal v[N_DISC_VALUES]);
/* Second moments sum_s v v' r of the profiles of harmonic m; their trace, which is returned, is the energy */
PETSC_INTERN PetscReal DiscMomentsOf(const Disc *disc, PetscInt mode, int direction, int m,
                                     PetscReal moments[N_DISC_VALUES * N_DISC_VALUES]);
/* Middle of the k-th of DISC_SAMPLES parts of the range, m; weight of a place in integrals over the ring */
PETSC_INTERN PetscReal DiscSample(const Disc *disc, int k);
PETSC_INTERN PetscReal DiscSampleWeight(const Disc *disc, PetscReal s);
/* Energy of what harmonic m alone fits of directions first to last */
PETSC_INTERN PetscErrorCode DiscExplain(const Disc *disc, PetscInt mode, int m, int first, int last, PetscReal *energy);
PETSC_INTERN PetscErrorCode DiscDestroy(Disc *disc);
/* label/name.c - sign changes of the principal profile of harmonic m in a direction, with its moments; values below a
   twentieth of the largest count as zero */
PETSC_INTERN PetscErrorCode DiscNodalCircles(const Disc *disc, PetscInt mode, int direction, int m,
                                             const PetscReal moments[], int *n);
/* "(circles,diameters+)"; energy of what the harmonic of the name alone fits */
PETSC_INTERN PetscErrorCode DiscName(const Disc *disc, PetscInt mode, char name[], size_t size, PetscReal *energy);
/* label/inplane.c - "IP-C(diameters+)" or "IP-R(diameters+)", with nodal circles "IP-C(circles,diameters+)", and the
   same energy in the plane */
PETSC_INTERN PetscErrorCode DiscNameInPlane(const Disc *disc, PetscInt mode, char name[], size_t size,
                                            PetscReal *energy);
