/*
   The table of modes for people and for files, and the shapes.
*/
#include "modes/modesimpl.h"
#include "base/events.h"
#include "base/text.h"

static PetscReal ModeFrequency(const Mode *mode)
{
  return mode->omega / (2 * PETSC_PI);
}

/* Damping ratio -Re(lambda) / |lambda|; 0 for a rigid mode */
static PetscReal ModeDampingRatio(const Mode *mode)
{
  const PetscReal size = PetscSqrtReal(mode->sigma * mode->sigma + mode->omega * mode->omega);

  return size > 0 && mode->sigma != 0 ? -mode->sigma / size : 0;
}

/* The model of the pencil, NULL for loaded matrices, and its contact */
static PetscErrorCode ModesGetModel(Modes modes, Model *model, Contact *contact)
{
  Operators operators;

  PetscFunctionBeginUser;
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetModel(operators, model, contact));
  PetscFunctionReturn(0);
}

/* What the modes are about */
static PetscErrorCode ModesViewState(Modes modes, PetscViewer viewer)
{
  const ContactPair *pair;
  Contact            contact;
  PencilClosed       closed;
  PetscInt           n, n_all;
  PetscBool          from_state;

  PetscFunctionBeginUser;
  PetscCall(PencilGetClosed(modes->pencil, &closed, &from_state));
  if (!from_state) PetscFunctionReturn(0);
  PetscCall(ModesGetModel(modes, NULL, &contact));
  PetscCall(ContactGetPairs(contact, &n, &n_all, &pair));
  PetscCall(PetscViewerASCIIPrintf(
    viewer, "about the sliding state: %" PetscInt_FMT " of %" PetscInt_FMT " pairs closed", closed.n, n_all));
  if (closed.n_stick + closed.n_limit)
    PetscCall(PetscViewerASCIIPrintf(
      viewer, "; of those that hold by friction %" PetscInt_FMT " stick, %" PetscInt_FMT " slip freely at its limit",
      closed.n_stick, closed.n_limit));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesView(Modes modes, PetscViewer viewer)
{
  static const char *const mark[] = {[MODE_STABLE] = "", [MODE_NEUTRAL] = "  neutral", [MODE_UNSTABLE] = "  UNSTABLE"};

  PetscInt n[] = {[MODE_STABLE] = 0, [MODE_NEUTRAL] = 0, [MODE_UNSTABLE] = 0};

  PetscFunctionBeginUser;
  PetscCall(ModesBalance(modes));
  PetscCall(
    PetscViewerASCIIPrintf(viewer, "mode    freq Hz   growth 1/s  damping %%  error Hz  condition  backward  label\n"));
  for (PetscInt i = 0; i < modes->n; i++) {
    const Mode *m = &modes->mode[i];

    n[m->state]++;
    PetscCall(PetscViewerASCIIPrintf(viewer, "%4" PetscInt_FMT " %10.3f %12.5g %10.5f %9.1e %10.4g %9.1e  %s%s\n",
                                     i + 1, (double)ModeFrequency(m), (double)m->sigma,
                                     (double)(100 * ModeDampingRatio(m)), (double)(m->error / (2 * PETSC_PI)),
                                     (double)m->condition, (double)m->backward_error, m->label, mark[m->state]));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, "%" PetscInt_FMT " mode%s", modes->n, modes->n == 1 ? "" : "s"));
  if (!modes->has_band) PetscCall(PetscViewerASCIIPrintf(viewer, " nearest to %.6g Hz", (double)modes->target));
  PetscCall(PetscViewerASCIIPrintf(viewer, ", %" PetscInt_FMT " unstable", n[MODE_UNSTABLE]));
  if (n[MODE_NEUTRAL]) PetscCall(PetscViewerASCIIPrintf(viewer, ", %" PetscInt_FMT " neutral", n[MODE_NEUTRAL]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\ncompleteness: %s\n", modes->completeness));
  PetscCall(ModesViewLimit(modes, n[MODE_NEUTRAL] ? PETSC_TRUE : PETSC_FALSE, viewer));
  if (n[MODE_UNSTABLE]) PetscCall(ModesViewCauses(modes, viewer));
  if (n[MODE_UNSTABLE]) PetscCall(ModesViewSensitivities(modes, viewer));
  if (n[MODE_UNSTABLE]) PetscCall(ComponentsView(modes, viewer));
  PetscCall(ChangesView(modes, viewer));
  if (ShiftInvertShows() && modes->solver[0])
    PetscCall(PetscViewerASCIIPrintf(viewer, "undamped modes: %s, %" PetscInt_FMT " shift%s\n", modes->solver,
                                     modes->shifts, modes->shifts == 1 ? "" : "s"));
  if (ShiftInvertShows()) PetscCall(SavedView(modes, viewer));
  PetscCall(ModesViewState(modes, viewer));
  PetscFunctionReturn(0);
}

/* Header of modes.csv; further columns only at its end, since others read it */
static PetscErrorCode ModesOpenTable(Operators operators, PetscInt n_parts, const Mesh *mesh, Results results,
                                     ResultsTable *table)
{
  char        header[16384], column[256];
  const char *name;

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(header,
                         "mode,freq_hz,growth_rad_s,damping_ratio,backward_error,condition,unstable,label,error_hz",
                         sizeof(header)));
  for (PetscInt part = 0; part < n_parts; part++) {
    PetscCall(OperatorsGetPartName(operators, part, &name));
    PetscCall(PetscSNPrintf(column, sizeof(column), ",part_%s_percent", name));
    PetscCall(TextAdd(header, column, sizeof(header)));
  }
  if (mesh) PetscCall(TextAdd(header, ",label_percent", sizeof(header)));
  PetscCall(TextAdd(header, ",state,mechanism,partner", sizeof(header)));
  PetscCall(ResultsTableOpen(results, "modes", header, table));
  PetscFunctionReturn(0);
}

/* modes.csv */
static PetscErrorCode ModesWriteTable(Modes modes, Operators operators, const Mesh *mesh, Results results)
{
  const ModeMechanism *mechanism;
  PetscInt             n_parts;
  ResultsTable         table;

  PetscFunctionBeginUser;
  PetscCall(ModesGetMechanisms(modes, &mechanism));
  PetscCall(OperatorsCountParts(operators, &n_parts));
  PetscCall(ModesOpenTable(operators, n_parts, mesh, results, &table));
  for (PetscInt i = 0; i < modes->n; i++) {
    const Mode *m             = &modes->mode[i];
    char        percent[2048] = "", number[32];

    for (PetscInt part = 0; part < n_parts; part++) {
      PetscCall(PetscSNPrintf(number, sizeof(number), ",%.15g", modes->part_percent[i * n_parts + part]));
      PetscCall(TextAdd(percent, number, sizeof(percent)));
    }
    if (mesh) {
      PetscCall(PetscSNPrintf(number, sizeof(number), ",%.15g", modes->label_percent[i]));
      PetscCall(TextAdd(percent, modes->label_percent[i] >= 0 ? number : ",", sizeof(percent)));
    }
    if (mechanism[i].partner >= 0)
      PetscCall(PetscSNPrintf(number, sizeof(number), "%d", (int)mechanism[i].partner + 1));
    else
      number[0] = 0;
    PetscCall(ResultsTableRow(table, "%d,%.15g,%.15g,%.15g,%.15g,%.15g,%d,\"%s\",%.15g%s,%s,%s,%s", (int)i + 1,
                              (double)ModeFrequency(m), (double)m->sigma, (double)ModeDampingRatio(m),
                              (double)m->backward_error, (double)m->condition, (int)m->unstable, m->label,
                              (double)(m->error / (2 * PETSC_PI)), percent, ModeStateName(m->state),
                              MechanismName(mechanism[i].kind, PETSC_FALSE), number));
  }
  PetscCall(ResultsTableClose(&table));
  PetscFunctionReturn(0);
}

/* modes.h5 and modes.xmf */
static PetscErrorCode ModesWriteShapes(Modes modes, Operators operators, const Mesh *mesh, Results results)
{
  PetscReal   *re, *im, *density;
  ResultsField field;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * mesh->n_nodes, &re, 3 * mesh->n_nodes, &im));
  PetscCall(ResultsFieldOpen(results, "modes", mesh, &field));
  for (PetscInt i = 0; i < modes->n; i++) {
    const Mode *m = &modes->mode[i];
    char        key[32], title[128];

    PetscCall(PetscSNPrintf(key, sizeof(key), "mode_%03d", (int)i + 1));
    PetscCall(PetscSNPrintf(title, sizeof(title), "%d: %.6g Hz, growth %.4g 1/s, %s", (int)i + 1,
                            (double)ModeFrequency(m), (double)m->sigma, m->label));
    PetscCall(OperatorsGetNodal(operators, modes->right.xr[i], re));
    PetscCall(OperatorsGetNodal(operators, modes->right.xi[i], im));
    PetscCall(ModesCreateFeedIn(modes, i, mesh, &density));
    PetscCall(ResultsFieldWriteMode(field, key, title, re, im,
                                    density ? &(const ResultsNodal){"feed_in_w_m2", 1, density} : NULL));
    PetscCall(PetscFree(density));
  }
  PetscCall(ResultsFieldClose(&field));
  PetscCall(PetscFree2(re, im));
  PetscFunctionReturn(0);
}

PetscErrorCode ModesWrite(Modes modes, Results results)
{
  PetscBool   wanted;
  Model       model;
  Operators   operators;
  const Mesh *mesh;

  PetscFunctionBeginUser;
  PetscCall(ModesGetModel(modes, &model, NULL));
  PetscCall(PencilGetOperators(modes->pencil, &operators));
  PetscCall(OperatorsGetMesh(operators, &mesh));
  PetscCall(ModesBalance(modes));
  PetscCall(ModesWriteTable(modes, operators, mesh, results));
  PetscCall(EventBegin(EVENT_CAUSES));
  PetscCall(ModesWriteCauses(modes, results));
  PetscCall(ModesWriteFeedIn(modes, results));
  PetscCall(EventEnd(EVENT_CAUSES));
  PetscCall(ModesWriteSensitivities(modes, results));
  PetscCall(EventBegin(EVENT_EFFECTS));
  PetscCall(ModesWriteEffects(modes, operators, mesh, results));
  PetscCall(EventEnd(EVENT_EFFECTS));
  PetscCall(ComponentsWrite(modes, results));
  PetscCall(ChangesWrite(modes, results));
  if (mesh) PetscCall(ModesWriteSound(modes, mesh, results));
  PetscCall(ResultsNote(results, "completeness", "%s", modes->completeness));
  PetscCall(ResultsWantFields(results, &wanted));
  if (mesh && wanted) PetscCall(ModesWriteShapes(modes, operators, mesh, results));
  if (modes->filters) PetscCall(ModesWriteFilters(modes, model, results));
  PetscFunctionReturn(0);
}
