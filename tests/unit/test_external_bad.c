/*
   Unit test of what External refuses, and of motions of a body with radial and circumferential components.

   References: the messages; the displacement itself, which every node of the set has to reach.
*/
#include "check.h"
#include "externalscene.h"
#include "scratch.h"
#include "petscmain.h"

#define PULL "-loads pull -pull_set head_top -pull_force 1,0,0 "
#define LIFT "-motions lift -lift_set head_top -lift_displacement 1,0,0 -lift_ramp 1 "
#define MORE "-motions lift,more -more_set head_edge "
#define HIT  "-impulses hit -hit_at 0,0,1 -hit_impulse 1,0,0 "

/* Options, and what the error begins with */
static const char *const bad[][2] = {
  {PULL "-pull_ramp -1",               "-pull_ramp -1 must not be negative (s)"                     },
  {"-head_velocity 1",                 "-head_velocity has 1 values; give 3"                       },
  {"-head_velocity inf,0,0",           "-head_velocity value inf must be a finite number"          },
  {LIFT "-lift_set hat",               "-lift_set: the mesh has no set named 'hat'; it names: "    },
  {LIFT "-lift_ramp 0",                "-lift_ramp 0 must be given and positive (s)"               },
  {LIFT "-lift_delay -2",              "-lift_delay -2 must not be negative (s)"                    },
  {LIFT "-lift_set foot_bottom",       "-lift_set foot_bottom is held by supports in all"          },
  {LIFT MORE "-more_directions xz",    "-more_set head_edge has nodes that another of the -motions"},
  {"-impulses hit -hit_impulse 1,0,0", "-hit_at must be given: the place x,y,z (m)"                },
  {HIT "-hit_at 0,0,inf",              "-hit_at value inf must be a finite number"                 },
  {"-impulses hit -hit_at 0,0,1",      "-hit_impulse must be given: three values (N s), zeros for" },
  {HIT "-hit_time -1",                 "-hit_time -1 must not be negative (s)"                      },
  {HIT "-hit_part neck",               "-hit_part neck is none of the -parts: foot, head"          },
  {HIT "-hit_at 0,0,0",                "-hit_impulse does nothing: the node at 0, 0, 0 m is held"  },
  {HIT LIFT,                           "-hit_impulse does nothing: the node at 0, 0, 1 m is held"  },
};

/* The same of what the model reads */
static const char *const bad_model[][2] = {
  {"-motions 2lift",                  "-motions '2lift' is no name"                                 },
  {"-motions lift,lift",              "-motions names 'lift' twice"                                 },
  {"-motions lift -lift_ramp 1",      "-lift_set must be given: a named set of the mesh"            },
  {LIFT "-lift_displacement 0,0,0",   "-lift_displacement is zero: give it (m), or -lift_directions"},
  {LIFT "-lift_displacement nan,0,0", "-lift_displacement value nan must be a finite number"        },
  {LIFT "-lift_directions xw",        "-lift_directions 'xw' must be some of the letters x, y, z"   },
  {LIFT "-lift_directions",           "-lift_directions '' must be some of the letters x, y, z"     },
  {LIFT "-lift_directions y",         "-lift_displacement has 1 m along x, which -lift_directions y"},
};

#define RING                                                                                                           \
  "-model_source rig -rig_pad 0 -rig_disc_mesh axisymmetric -rig_disc_elements 2,16,1 -parts disc -disc_young 210e9 "  \
  "-disc_density 7800 -motions lift -lift_set disc_inner -lift_ramp 1 "

/* A disc with radial and circumferential components, moved by (1, 2, 3) m. Breaks when: the displacement is not turned
   into them, or one direction across the axis alone is taken for one of them */
static PetscErrorCode TestTurned(int *failed)
{
  const PetscReal lift[3] = {1, 2, 3};
  PetscReal       wrong = 0, turned = 0;
  PetscInt        n = 0;
  ExternalPower   power;
  Scene           s;

  PetscFunctionBeginUser;
  PetscCall(ChainCreate(RING, "-lift_displacement 1,2,3", &s.chain));
  PetscCall(ExternalCreate(PETSC_COMM_WORLD, s.chain.model, &s.external));
  PetscCall(ExternalSetFromOptions(s.external));
  PetscCall(SceneEnd(&s));
  PetscCall(ExternalSetUp(s.external, s.chain.operators, s.bodies));
  PetscCall(SceneAdvance(&s, 0, 1, &power));
  for (PetscInt i = 0; i < s.layout->n_vertices; i++) {
    PetscReal here[3];

    LayoutGet(s.layout, i, s.v, here);
    turned = PetscMax(turned, PetscAbsReal(s.layout->basis[9 * i] * s.layout->basis[9 * i + 1]));
    turned = PetscMax(turned, PetscAbsReal(s.layout->basis[9 * i + 3] * s.layout->basis[9 * i + 4]));
    if (here[2] == 0) continue;
    n += s.layout->owned[i];
    for (int d = 0; d < 3; d++) wrong = PetscMax(wrong, PetscAbsReal(here[d] - lift[d]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &turned, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  *failed += CheckTrue("the disc has components that turn", turned > 0.3, turned);
  *failed += CheckClose("nodes that move", (double)n, 32, 0);
  *failed += CheckClose("largest error of a velocity, m/s", wrong, 0, 1e-14);
  PetscCall(SceneDestroy(&s));
  PetscFunctionReturn(0);
}

/* Whether the disc of TestTurned() refuses a displacement */
static PetscErrorCode TestTurnedBad(const char displacement[], PetscBool refuses, int *failed)
{
  Scratch        scratch;
  PetscErrorCode error;
  Scene          s;

  PetscFunctionBeginUser;
  PetscCall(ScratchCreate(&scratch));
  PetscCall(ChainCreate(RING, displacement, &s.chain));
  PetscCall(ExternalCreate(PETSC_COMM_WORLD, s.chain.model, &s.external));
  PetscCall(ExternalSetFromOptions(s.external));
  PetscCall(SceneEnd(&s));
  error = ExternalSetUp(s.external, s.chain.operators, s.bodies);
  *failed += CheckTrue("one direction across the axis alone is refused, others are not",
                       refuses == !!strstr(scratch.message, "splits the radial and circumferential components"), error);
  PetscCall(SceneDestroy(&s));
  *failed += CheckTrue("scratch folder is empty", ScratchDestroy(&scratch), 0);
  PetscFunctionReturn(0);
}

/* Breaks when: a value that cannot be passes, or the message names another option */
static PetscErrorCode TestBad(int *failed)
{
  Scratch scratch;

  PetscFunctionBeginUser;
  PetscCall(ScratchCreate(&scratch));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(bad); i++) {
    Scene          s = {.bodies = NULL};
    PetscErrorCode error;

    scratch.message[0] = '\0';
    PetscCall(SceneBegin(bad[i][0], &s));
    PetscCall(SceneEnd(&s));
    error = ExternalSetFromOptions(s.external);
    if (!error) error = ExternalSetUp(s.external, s.chain.operators, s.bodies);
    *failed += CheckTrue(bad[i][1], error == PETSC_ERR_USER_INPUT && strstr(scratch.message, bad[i][1]), error);
    if (!strstr(scratch.message, bad[i][1])) printf("     says: %s\n", scratch.message);
    PetscCall(SceneDestroy(&s));
  }
  *failed += CheckTrue("scratch folder is empty", ScratchDestroy(&scratch), 0);
  PetscFunctionReturn(0);
}

/* The same for the model's options of motions */
static PetscErrorCode TestBadModel(int *failed)
{
  Scratch scratch;

  PetscFunctionBeginUser;
  PetscCall(ScratchCreate(&scratch));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(bad_model); i++) {
    PetscErrorCode error;
    Model          model;

    scratch.message[0] = '\0';
    PetscCall(PetscOptionsClear(NULL));
    PetscCall(PetscOptionsInsertString(NULL, BAR "-model_source rig"));
    PetscCall(PetscOptionsInsertString(NULL, bad_model[i][0]));
    PetscCall(ModelCreate(PETSC_COMM_WORLD, &model));
    error = ModelSetFromOptions(model);
    *failed +=
      CheckTrue(bad_model[i][1], error == PETSC_ERR_USER_INPUT && strstr(scratch.message, bad_model[i][1]), error);
    if (!strstr(scratch.message, bad_model[i][1])) printf("     says: %s\n", scratch.message);
    PetscCall(ModelDestroy(&model));
  }
  *failed += CheckTrue("scratch folder is empty", ScratchDestroy(&scratch), 0);
  PetscFunctionReturn(0);
}

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TestTurned(failed));
  PetscCall(TestTurnedBad("-lift_displacement 1,0,0", PETSC_TRUE, failed));
  PetscCall(TestTurnedBad("-lift_displacement 0,1,1", PETSC_TRUE, failed));
  PetscCall(TestTurnedBad("-lift_displacement 0,0,1", PETSC_FALSE, failed));
  PetscCall(TestBad(failed));
  PetscCall(TestBadModel(failed));
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
