/*
   Films - states of one mesh in time. Each frame has its own HDF5 and XDMF files, so that it is whole as soon as it is
   written; the XDMF file of the film lists all frames with their times, and is replaced by a longer one after each.
*/
#include "resultsimpl.h"

struct _p_ResultsFilm {
  Results     results;
  char        name[64], frame[64];
  const Mesh *mesh;           /* borrowed */
  PetscInt    n_frames, room; /* frames so far, and times that there is room for */
  PetscReal  *time;           /* [n_frames], s */
};

PetscErrorCode ResultsFilmCreate(Results results, const char name[], const char frame[], const Mesh *mesh,
                                 ResultsFilm *film)
{
  ResultsFilm f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  f->results = results;
  f->mesh    = mesh;
  PetscCall(PetscStrncpy(f->name, name, sizeof(f->name)));
  PetscCall(PetscStrncpy(f->frame, frame, sizeof(f->frame)));
  *film = f;
  PetscFunctionReturn(0);
}

/* Makes room for n times */
static PetscErrorCode FilmReserve(ResultsFilm film, PetscInt n)
{
  PetscFunctionBeginUser;
  if (n <= film->room) PetscFunctionReturn(0);
  film->room = PetscMax(2 * film->room, PetscMax(n, 16));
  PetscCall(PetscRealloc((size_t)film->room * sizeof(*film->time), &film->time));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFilmGetTimes(ResultsFilm film, PetscInt *n, const PetscReal **times)
{
  PetscFunctionBeginUser;
  *n     = film->n_frames;
  *times = film->time;
  PetscFunctionReturn(0);
}

/* Name of frame k without an extension */
static PetscErrorCode FrameName(ResultsFilm film, PetscInt k, char name[80])
{
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, 80, "%s_%06d", film->frame, (int)k));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFilmSetTimes(ResultsFilm film, PetscInt n, const PetscReal times[])
{
  char name[80], file[96];

  PetscFunctionBeginUser;
  PetscCall(FilmReserve(film, n));
  PetscCall(PetscArraycpy(film->time, times, n));
  film->n_frames = n;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s.xmf", film->name));
  if (n > 0) PetscCall(ResultsKeep(film->results, file)); /* it stays, also where no frame follows */
  for (PetscInt k = 0; k < n; k++) {
    PetscCall(FrameName(film, k, name));
    PetscCall(PetscSNPrintf(file, sizeof(file), "%s.h5", name));
    PetscCall(ResultsKeep(film->results, file));
    PetscCall(PetscSNPrintf(file, sizeof(file), "%s.xmf", name));
    PetscCall(ResultsKeep(film->results, file));
  }
  PetscFunctionReturn(0);
}

/* Writes frame k, and describes its mesh in xdmf */
static PetscErrorCode FrameWrite(ResultsFilm film, PetscInt k, const char title[], PetscInt n,
                                 const ResultsNodal arrays[], Xdmf *xdmf)
{
  char         name[80];
  ResultsField field;

  PetscFunctionBeginUser;
  PetscCall(FrameName(film, k, name));
  PetscCall(ResultsFieldOpen(film->results, name, film->mesh, &field));
  field->timed = PETSC_TRUE;
  field->time  = film->time[k];
  PetscCall(ResultsFieldWriteNodal(field, title, n, arrays));
  xdmf->element = field->xdmf.element;
  xdmf->n_ids   = field->xdmf.n_ids;
  xdmf->n_nodes = field->xdmf.n_nodes;
  xdmf->n_cells = field->xdmf.n_cells;
  PetscCall(ResultsFieldClose(&field));
  PetscFunctionReturn(0);
}

/* Writes the list of the frames in place of the last one */
static PetscErrorCode FramesList(ResultsFilm film, PetscInt n, const ResultsNodal arrays[], Xdmf *xdmf)
{
  OutFile *const file = &xdmf->file;

  PetscFunctionBeginUser;
  PetscCall(OutFileSetName(film->results, film->name, ".xmf", file));
  PetscCall(OutFileOpenText(file));
  PetscCall(XdmfBegin(xdmf, film->mesh->n_parts, film->mesh->part));
  for (PetscInt k = 0; k < film->n_frames; k++) {
    char name[80];

    PetscCall(FrameName(film, k, name));
    PetscCall(PetscSNPrintf(xdmf->h5_name, sizeof(xdmf->h5_name), "%s.h5", name));
    PetscCall(XdmfGridBegin(xdmf, name, NULL, &film->time[k]));
    for (PetscInt i = 0; i < n; i++) PetscCall(XdmfNodal(xdmf, arrays[i].key, arrays[i].key, "", arrays[i].width));
    PetscCall(XdmfGridEnd(xdmf));
  }
  PetscCall(XdmfEnd(xdmf));
  PetscCall(OutFilesPublish(1, &file));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFilmWrite(ResultsFilm film, PetscReal time, const char title[], PetscInt n,
                                const ResultsNodal arrays[])
{
  Xdmf xdmf = {.n_grids = 0};

  PetscFunctionBeginUser;
  PetscCall(FilmReserve(film, film->n_frames + 1));
  film->time[film->n_frames] = time;
  PetscCall(FrameWrite(film, film->n_frames, title, n, arrays, &xdmf));
  film->n_frames++;
  PetscCall(FramesList(film, n, arrays, &xdmf));
  PetscFunctionReturn(0);
}

PetscErrorCode ResultsFilmDestroy(ResultsFilm *film)
{
  PetscFunctionBeginUser;
  if (!*film) PetscFunctionReturn(0);
  PetscCall(PetscFree((*film)->time));
  PetscCall(PetscFree(*film));
  PetscFunctionReturn(0);
}
