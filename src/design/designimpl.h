/* Private to design/: its record */
#pragma once

#include <squeal/design.h>
#include "quiet/cube.h"
#include "sweep/box/box.h"

/* A design that was looked at */
typedef struct {
  PetscReal z[CUBE_MAX_VARIABLES]; /* in t of the cube */
  PetscInt  n_unstable;            /* modes of all scenarios */
  PetscInt  n_scenarios;           /* scenarios with one */
  PetscReal excess, omega;         /* largest growth beyond the limit, 1/s, and where, rad/s */
  PetscInt  worst;                 /* its scenario */
  PetscReal change, mass;          /* |z - own| / sqrt(n); mass beside that of the scene */
  PetscBool solved, good;          /* in full, at the worst scenario; and there, too, nothing is unstable */
  PetscReal full_excess;           /* there */
  PetscInt  n_classes, n_apart;    /* contact statuses of its scenarios; scenarios with none of the classes */
  PetscInt  apart;                 /* most pairs that such a status differs in from the class taken */
} DesignPoint;

/* a + g' (z - at) <= 0 */
typedef struct {
  PetscReal a, g[CUBE_MAX_VARIABLES], at[CUBE_MAX_VARIABLES];
} DesignCut;

/* A corner of the uncertain box in full */
typedef struct {
  PetscReal t[CUBE_MAX_VARIABLES], excess, sigma, omega, error;
  PetscInt  n_unstable, n_modes, n_closed; /* closed pairs, -1 without a sliding state */
} DesignCorner;

struct _p_Design {
  MPI_Comm  comm;
  Operators operators;
  Box       box;
  /* set by options */
  CubeOptions options, uncertain_options;
  PetscInt    n_inside, n_corners, max_designs, n_starts;
  PetscBool   corners_given;
  PetscReal   probability, margin, mass_weight;
  char        varied[2 * CUBE_MAX_TEXT];
  /* results */
  Cube           cube, uncertain;
  PetscInt       n_scenarios;
  PetscReal     *scenario;       /* [n_scenarios][uncertain.n] t */
  PetscInt      *status, *apart; /* [n_scenarios] classes of the design looked at (box.h) */
  PetscReal     *train;          /* [n_train][cube.n + uncertain.n] t of the points of the basis */
  PetscInt       n_train;
  PetscReal     *known; /* [n_known][cube.n + uncertain.n] t of all points whose own status is a class, and which */
  PetscInt       n_known, *known_status;
  PetscReal      mass_slope[CUBE_MAX_VARIABLES]; /* d (m / m(0)) / d z */
  PetscReal      mass;                           /* kg of the moving unknowns, of the scene */
  PetscInt       n_cuts, n_points, best, n_full; /* full solutions: beside those of the basis */
  DesignCut     *cut;
  DesignPoint   *point; /* [max_designs] */
  DesignCorner  *corner;
  PetscBool      found, again; /* again: the last one that was found goes on with one more scenario */
  PetscInt       n_rejected;   /* designs that a corner in full was unstable of */
  PetscInt       n_elsewhere;  /* designs of -design_starts that were looked at */
  PetscReal      elsewhere;    /* least excess of them, with the statuses of the last designs */
  PetscLogDouble seconds[3];   /* basis, designs, corners */
};

extern const QuantityTable design_quantities;

/* starts.c - the least bad ones of designs spread over the box, by excess */
#define DESIGN_STARTS 3
typedef struct {
  PetscInt  n;
  PetscReal z[DESIGN_STARTS][CUBE_MAX_VARIABLES], excess[DESIGN_STARTS];
} DesignList;
/* Collective */
PETSC_INTERN PetscErrorCode DesignStarts(Design design, DesignList *starts);
/* search.c - the designs; called again it goes on behind one that was rejected */
PETSC_INTERN PetscErrorCode DesignSearch(Design design);
/* The design that was found is none: the corner that says so becomes a scenario, or where it is one already the next
   designs aim farther beyond the limit */
PETSC_INTERN PetscErrorCode DesignReject(Design design, const DesignCorner *corner);
/* The least bad design, where none is good */
PETSC_INTERN void DesignChooseBest(Design design);
/* cuts that a good design does not keep are dropped */
PETSC_INTERN void DesignForget(Design design, const PetscReal good[]);
/* scenario.c - the scenarios; a design at all of them, its cuts are kept; all parameters p of a design at a scenario t.
   Collective */
PETSC_INTERN PetscErrorCode DesignScenarios(Design design);
/* A point t of the uncertain box as a further scenario, at most -design_max of them; added = it was none yet. It has
   the contact status of the worst one until statuses are found */
PETSC_INTERN PetscErrorCode DesignAddScenario(Design design, const PetscReal t[], PetscBool *added);
PETSC_INTERN PetscErrorCode DesignLook(Design design, PetscBool keep, DesignPoint *point);
/* A point with a status of its own */
PETSC_INTERN PetscErrorCode DesignKnow(Design design, const PetscReal z[], const PetscReal t[], PetscInt status);
/* The largest excess at z with the statuses of the design before, scenarios in this order, which puts in front those
   that end it: one with an excess above the bound, or, where `unstable` is asked for, an unstable mode. Collective */
PETSC_INTERN PetscErrorCode DesignGlance(Design design, const PetscReal z[], PetscReal bound, PetscInt order[],
                                         PetscReal *excess, PetscBool *unstable);
/* The contact statuses of all scenarios at z become those that designs are looked at with. Collective */
PETSC_INTERN PetscErrorCode DesignFindStatuses(Design design, const PetscReal z[], PetscBool *changed);
PETSC_INTERN void           DesignParameters(const Design d, const PetscReal z[], const PetscReal t[], PetscReal p[]);
/* full.c - the full solution of a design at a scenario t; at the corners of the uncertain box, where all must be stable
   up to the first one that is not: n_unstable of `unstable` is 0 where there is none. Collective */
PETSC_INTERN PetscErrorCode DesignFull(Design design, const PetscReal z[], const PetscReal t[], DesignCorner *corner);
PETSC_INTERN PetscErrorCode DesignCorners(Design design, DesignCorner *unstable);
/* Mass of the scene, and how it changes. Collective */
PETSC_INTERN PetscErrorCode DesignMass(Design design);
/* step.c - the next design from the cuts, within radius of `from` */
PETSC_INTERN PetscErrorCode DesignStep(Design design, const PetscReal from[], PetscReal radius, PetscReal z[]);
