/*
   Unit test of the history: when rows are due, the columns and numbers of transient.csv, states of pairs, growth of the
   vibration, snapshots. Motions are made up by formula (madehistory.h), and so are the references.
*/
#include "madehistory.h"
#include <hdf5.h>

/* Breaks when: a multiple is met at another step than the nearest, twice, or not at all. Reference: the first n with
   n >= 3.5 k - 0.5; times are exact in binary */
static int TestDue(void)
{
  static const int expected[] = {0, 3, 7, 10, 14, 17, 21};
  Schedule         some = {.interval = 0.4375}, every = {.interval = 1e-30}, usual = {.interval = 5e-6}, never = {0};
  int              failed = 0, n_some = 0, n_every = 0, n_usual = 0, n_never = 0, wrong = 0;

  for (int n = 0; n < 24; n++) {
    const PetscBool due = ScheduleIsDue(&some, 0.125 * n, 0.125);

    wrong += due != ScheduleMeet(&some, 0.125 * n, 0.125);
    if (due) wrong += n_some > 6 || expected[n_some++] != n;
    n_every += ScheduleMeet(&every, 0.125 * n, 0.125);
    n_never += ScheduleMeet(&never, 0.125 * n, 0.125);
  }
  failed += CheckTrue("an interval of 3.5 steps is met at steps 0 3 7 10 14 17 21", wrong == 0 && n_some == 7, n_some);
  failed += CheckClose("a short interval is met at every step", n_every, 24, 0);
  failed += CheckClose("no interval is never met", n_never, 0, 0);
  for (int n = 0; n <= 100000; n++) {
    const PetscBool due = ScheduleMeet(&usual, n * 1e-7, 1e-7);

    wrong += due != (n % 50 == 0);
    n_usual += due;
  }
  failed += CheckClose("50 steps an interval: rows", n_usual, 2001, 0);
  return failed + CheckTrue("each at its step", wrong == 0, wrong);
}

/* Breaks when: a run with another interval than the one that it goes on from leaves out or repeats rows. Reference: the
   first multiple of 0.3 s after that of 0.5 s which was met last, 1.5 s */
static int TestRestore(void)
{
  const Schedule kept = {.interval = 0.5, .next = 4}, none = {0};
  Schedule       same = {.interval = 0.5}, other = {.interval = 0.3}, first = {.interval = 0.3, .next = 7};

  ScheduleRestore(&same, &kept);
  ScheduleRestore(&other, &kept);
  ScheduleRestore(&first, &none);
  return CheckClose("the same interval goes on", (double)same.next, 4, 0) +
         CheckClose("another one after the last row", (double)other.next, 6, 0) +
         CheckClose("one that was not recorded begins", (double)first.next, 0, 0);
}

/* Breaks when: a rate outlives the vibration, or a vibration slower than a window has none. Reference: sigma = -30
   1/s of K at 200 Hz (peaks of K each 2.5 ms), then none after 10 windows of an energy that only rises */
static int TestQuiet(void)
{
  Growth growth = {.window = 1e-3};
  int    failed = 0;

  for (int n = 0; n < 4000; n++) {
    const double t = 5e-6 * n, c = cos(2 * M_PI * 200 * t);

    GrowthAdd(&growth, t, exp(-60 * t) * c * c);
  }
  failed += CheckClose("growth of a slow vibration", growth.n == 2 ? (double)growth.rate : NAN, -30, 0.3);
  for (int n = 4000; n < 6600; n++) GrowthAdd(&growth, 5e-6 * n, n);
  return failed + CheckTrue("no rate without vibration", growth.n == 0, (double)growth.n);
}

/* Breaks when: amplitude and energy are confused (factor 2), energy of slow motion counts, or the rate is known too
   early. Reference: sigma of K = 50 J + exp(2 sigma t) cos^2(omega t) J at 3430 Hz; rows of 5e-6 s miss at most
   (omega 2.5e-6 s)^2 = 0.3 % of a peak, 1.5 1/s in half a window */
static int TestGrowth(void)
{
  static const double sigma[] = {214, -150, 2000};
  int                 failed  = 0;

  for (int i = 0; i < 3; i++) {
    Growth growth = {.window = 1e-3};

    for (int n = 0; n <= 1600; n++) {
      const double t = 5e-6 * n, c = cos(2 * M_PI * 3430 * t);

      GrowthAdd(&growth, t, 50 + exp(2 * sigma[i] * t) * c * c);
      if (n == 399) failed += CheckTrue("no rate before two windows are complete", growth.n < 2, (double)growth.n);
    }
    failed += CheckTrue("rate is known", growth.n == 2, (double)growth.n);
    failed += CheckClose("growth of the vibration", (double)growth.rate, sigma[i], 3);
  }
  failed += TestQuiet();
  return failed;
}

/* Breaks when: a column is lost, moved, or gets another number; motions are not turned to Cartesian, belong to another
   node, or are summed twice where ranks share it */
static PetscErrorCode TestTable(Made *m, int *failed)
{
  static const char header[] =
    "time_s,normal_force_n,friction_force_n,n_closed,n_stick,kinetic_j,strain_j,external_work_j,friction_work_j,"
    "contact_work_j,damping_work_j,energy_error_j,integrator_work_j,friction_heat_j,n_open,projector_residual,"
    "projector_sweeps,"
    "tip_x_m,tip_y_m,tip_z_m,tip_vx_m_s,tip_vy_m_s,tip_vz_m_s,tip_ax_m_s2,tip_ay_m_s2,tip_az_m_s2,"
    "foot_x_m,foot_y_m,foot_z_m,foot_vx_m_s,foot_vy_m_s,foot_vz_m_s,foot_ax_m_s2,foot_ay_m_s2,foot_az_m_s2\n";
  static const PetscReal tip[] = {1, 1, 2}, foot[] = {0, 0, 0};
  const double           scale = 1e3;
  double                 worst = 0;
  History                history;
  char                  *text, *end;

  PetscFunctionBeginUser;
  PetscCall(MadeHistory(m, "-dynamics_history_interval 5e-6 -dynamics_live 0", &history));
  for (PetscInt n = 0; n <= 22; n++) PetscCall(MadeRecord(m, history, n));
  *failed += CheckTrue("no file under the final name", !MadeRemove(m, "transient.csv"), 0);
  PetscCall(HistoryClose(history));
  PetscCall(HistoryDestroy(&history));
  text = MadeRead(m, "transient.csv");
  if (m->rank == 0) *failed += CheckTrue("header", text && !strncmp(text, header, strlen(header)), 0);
  end = text ? text + strlen(header) : NULL;
  for (int n = 0; text && n <= 20; n += 5) {
    /* sweeps: the two interfaces have 3 n^2 and 5 n^2 in n steps each, so that 5 steps to n have 4 (2 n - 5) each */
    double row[35] = {n * MADE_DT, 100.5 + n, 27, 16, 7,     n + 0.25,          2, 3, 4, 5, 6,
                      9,           7,         8,  5,  2e-11, n ? 8 * n - 20 : 0};

    MadeMotion(tip, n * MADE_DT, &row[17], &row[20], &row[23]);
    MadeMotion(foot, n * MADE_DT, &row[26], &row[29], &row[32]);
    for (int i = 0; i < 35; i++) {
      worst = fmax(worst, fabs(strtod(end, &end) - row[i]) / (i < 17 ? 1 : scale));
      if (*end != (i < 34 ? ',' : '\n')) worst = INFINITY;
      end++;
    }
  }
  if (m->rank == 0) *failed += CheckClose("largest difference from the formula", worst, 0, 1e-15);
  if (m->rank == 0) *failed += CheckTrue("five rows", end && !*end, 0);
  free(text);
  *failed += CheckTrue("the table is there", MadeRemove(m, "transient.csv"), 0);
  PetscFunctionReturn(0);
}

/* Breaks when: pairs come in the order of the ranks, have no fixed number, or lose the size of the friction force.
   Every rank gives each second pair or more, from the last to the first */
static PetscErrorCode TestPairs(Made *m, int *failed)
{
  static const char      expected[]   = PAIRS_HEADER "\n0.5,1,a,0,1,2,0.25,3,5,slip\n0.5,2,a,1,2,3,0.25,3,5,slip\n"
                                                     "0.5,3,b,2,3,4,0.25,3,5,open\n0.5,4,b,3,4,5,0.25,3,5,open\n";
  const ContactInterface interfaces[] = {{.name = "a"}, {.name = "b"}};
  ContactState           state[4];
  PetscInt               n = 0, interface[4], number[4];
  PetscReal              x[12];
  PetscMPIInt            n_ranks;
  ResultsTable           table;
  char                  *text;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &n_ranks));
  for (int i = 3; i >= 0; i--) {
    if (i % n_ranks != m->rank) continue;
    state[n]     = (ContactState){i < 2 ? CONTACT_SLIP : CONTACT_OPEN, 0.25, {0, 0}, 3, {-3, 4}};
    interface[n] = i / 2;
    number[n]    = 70 + 3 * (i % 2);
    for (int d = 0; d < 3; d++) x[3 * n + d] = i + d;
    n++;
  }
  PetscCall(ResultsTableOpen(m->results, "contact_pairs", PAIRS_HEADER, &table));
  PetscCall(
    HistoryWritePairs(table, PETSC_COMM_WORLD, interfaces, 0.5, &(HistoryPairs){n, state, interface, number, x}));
  PetscCall(ResultsTableClose(&table));
  text = MadeRead(m, "contact_pairs.csv");
  if (m->rank == 0) *failed += CheckTrue("states of the pairs", text && !strcmp(text, expected), 0);
  free(text);
  *failed += CheckTrue("the table of pairs is there", MadeRemove(m, "contact_pairs.csv"), 0);
  PetscFunctionReturn(0);
}

/* Largest difference of dataset PointData/`key` from the formula at the file's own points; rank 0 */
static double FieldDifference(const Made *m, const char file_name[], const char key[], PetscReal t)
{
  static double points[24][3], values[24][3];
  char          path[PETSC_MAX_PATH_LEN + 32], key_path[64];
  double        worst = 0;
  hid_t         file, set;

  snprintf(path, sizeof(path), "%s/%s", m->dir, file_name);
  snprintf(key_path, sizeof(key_path), "/VTKHDF/PointData/%s", key);
  file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  set  = H5Dopen2(file, "/VTKHDF/Points", H5P_DEFAULT);
  if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, points) < 0) worst = INFINITY;
  H5Dclose(set);
  set = H5Dopen2(file, key_path, H5P_DEFAULT);
  if (H5Dget_storage_size(set) != sizeof(values)) worst = INFINITY;
  if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) worst = INFINITY;
  H5Dclose(set);
  H5Fclose(file);
  for (int i = 0; i < 24; i++) {
    PetscReal u[3], v[3], a[3];

    MadeMotion(points[i], t, u, v, a);
    for (int d = 0; d < 3; d++) worst = fmax(worst, fabs(values[i][d] - (key[0] == 'd' ? u : v)[d]));
  }
  return worst;
}

/* Breaks when: a snapshot is left out or misnumbered, has the state of another time, or the film does not list them
   with their times */
static PetscErrorCode TestSnapshots(Made *m, int *failed)
{
  static const char *const expected[] = {"<Grid Name=\"snapshot_000000\"",
                                         "<Time Value=\"0\"/>",
                                         "snapshot_000000.h5:/VTKHDF/PointData/displacement_m<",
                                         "snapshot_000000.h5:/VTKHDF/PointData/velocity_m_s<",
                                         "<Grid Name=\"snapshot_000001\"",
                                         "<Time Value=\"4e-06\"/>",
                                         "snapshot_000001.h5:/VTKHDF/Points<",
                                         "snapshot_000001.h5:/VTKHDF/PointData/displacement_m<",
                                         "</Xdmf>"};
  History                  history;
  char                    *text;
  const char              *place;

  PetscFunctionBeginUser;
  PetscCall(MadeHistory(m, "-dynamics_history_interval 1 -dynamics_snapshot_interval 4e-6", &history));
  for (PetscInt n = 0; n <= 6; n++) PetscCall(MadeRecord(m, history, n));
  PetscCall(HistoryClose(history));
  PetscCall(HistoryDestroy(&history));
  place = text = MadeRead(m, "transient.xmf");
  for (size_t i = 0; i < sizeof(expected) / sizeof(expected[0]) && place; i++) place = strstr(place, expected[i]);
  if (m->rank == 0) {
    *failed += CheckTrue("frames of the film, in order", place != NULL, 0);
    *failed += CheckClose("displacements", FieldDifference(m, "snapshot_000001.h5", "displacement_m", 4e-6), 0, 1e-15);
    *failed += CheckClose("velocities", FieldDifference(m, "snapshot_000001.h5", "velocity_m_s", 4e-6), 0, 1e-15);
    *failed +=
      CheckClose("velocities at the start", FieldDifference(m, "snapshot_000000.h5", "velocity_m_s", 0), 0, 1e-15);
  }
  free(text);
  text = MadeRead(m, "snapshot_000001.xmf");
  if (m->rank == 0) *failed += CheckTrue("a snapshot has its time", text && strstr(text, "Value=\"4e-06\"/>"), 0);
  free(text);
  *failed += CheckTrue("two snapshots, a film, a table",
                       MadeRemove(m, "snapshot_000000.h5") && MadeRemove(m, "snapshot_000000.xmf") &&
                         MadeRemove(m, "snapshot_000001.h5") && MadeRemove(m, "snapshot_000001.xmf") &&
                         MadeRemove(m, "transient.xmf") && MadeRemove(m, "transient.csv"),
                       0);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  Made m      = {0};
  int  failed = 0;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(MadeCreate(&m));
  failed += TestDue();
  failed += TestRestore();
  failed += TestGrowth();
  PetscCall(TestTable(&m, &failed));
  PetscCall(TestPairs(&m, &failed));
  PetscCall(TestSnapshots(&m, &failed));
  PetscCall(MadeDestroy(&m, &failed));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD));
  PetscCall(PetscFinalize());
  return failed ? 1 : 0;
}
