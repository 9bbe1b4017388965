/* Matrix Market: superelement_k.mtx and so on, the lower half in coordinates, all 17 digits; the table of squeal says
   what the unknowns are */
#include "text.h"

static PetscErrorCode MarketEntry(void *ctx, PetscInt i, PetscInt j, PetscReal value)
{
  PetscFunctionBeginUser;
  PetscCall(TextPrint(ctx, "%" PetscInt_FMT " %" PetscInt_FMT " %.17g\n", i + 1, j + 1, (double)value));
  PetscFunctionReturn(0);
}

PetscErrorCode MarketWrite(Substructure s, Results results)
{
  TextMatrix     matrix[3];
  const PetscInt n = TextMatrices(s, matrix);

  PetscFunctionBeginUser;
  for (PetscInt t = 0; t < n; t++) {
    char     name[64], parts[160];
    PetscInt n_entries, n_again;
    Text     text;

    PetscCall(TextParts(s, sizeof(parts), parts));
    PetscCall(PetscSNPrintf(name, sizeof(name), "superelement_%c.mtx", matrix[t].letter));
    PetscCall(TextForEach(matrix[t].A, NULL, NULL, &n_entries));
    PetscCall(TextCreate(s->comm, &text));
    PetscCall(TextPrint(&text, "%%%%MatrixMarket matrix coordinate real symmetric\n%% superelement of %s: %s\n", parts,
                        matrix[t].unit));
    PetscCall(TextPrint(&text, "%" PetscInt_FMT " %" PetscInt_FMT " %" PetscInt_FMT "\n", s->n, s->n, n_entries));
    PetscCall(TextForEach(matrix[t].A, MarketEntry, &text, &n_again));
    PetscCall(TextWrite(&text, s, results, name));
  }
  PetscFunctionReturn(0);
}
