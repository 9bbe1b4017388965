/*
   XDMF - the text beside HDF5 files: a temporal collection with one grid per mode or state. Time is that of the state
   (s), or the number of the grid, and the attributes of modes have the same names in all grids, so that ParaView
   steps through them. All values are those of the group /VTKHDF of the HDF5 file. Reference: XDMF Model and Format,
   version 2.
*/
#include "resultsimpl.h"
#include <string.h>

/* Prints a string as the value of an XML attribute */
static PetscErrorCode XdmfText(OutFile *file, const char text[])
{
  static const char *const entities[][2] = {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}};

  PetscFunctionBeginUser;
  for (; *text; text++) {
    const char *entity = NULL;

    for (size_t i = 0; i < sizeof(entities) / sizeof(entities[0]); i++) {
      if (*text == entities[i][0][0]) entity = entities[i][1];
    }
    if (entity)
      PetscCall(OutFilePrint(file, "%s", entity));
    else
      PetscCall(OutFilePrint(file, "%c", *text));
  }
  PetscFunctionReturn(0);
}

/* Prints an <Information> element */
static PetscErrorCode XdmfInformation(OutFile *file, const char indent[], const char name[], const char value[])
{
  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(file, "%s<Information Name=\"%s\" Value=\"", indent, name));
  PetscCall(XdmfText(file, value));
  PetscCall(OutFilePrint(file, "\"/>\n"));
  PetscFunctionReturn(0);
}

/* Prints a <DataItem>: dataset `path` of the group /VTKHDF, of shape [n] (width 1) or [n][width] */
static PetscErrorCode XdmfItem(Xdmf *xdmf, const char number[], size_t precision, PetscInt n, PetscInt width,
                               const char path[])
{
  OutFile *file = &xdmf->file;

  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(
    file, "          <DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"%d\" Dimensions=\"%" PetscInt_FMT, number,
    (int)precision, n));
  if (width > 1) PetscCall(OutFilePrint(file, " %" PetscInt_FMT, width));
  PetscCall(OutFilePrint(file, "\">"));
  PetscCall(XdmfText(file, xdmf->h5_name));
  PetscCall(OutFilePrint(file, ":/VTKHDF/%s</DataItem>\n", path));
  PetscFunctionReturn(0);
}

/* Prints the head of the file, with the names of the parts */
PetscErrorCode XdmfBegin(Xdmf *xdmf, PetscInt n_parts, const char *const parts[])
{
  OutFile *file = &xdmf->file;
  char     number[16];

  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(file, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n"));
  for (PetscInt i = 0; i < n_parts; i++) {
    PetscCall(PetscSNPrintf(number, sizeof(number), "part_%d", (int)i));
    PetscCall(XdmfInformation(file, "    ", number, parts[i]));
  }
  PetscCall(OutFilePrint(file, "    <Grid Name=\"shapes\" GridType=\"Collection\" CollectionType=\"Temporal\">\n"));
  PetscFunctionReturn(0);
}

/* Prints the mesh and the part of each cell */
static PetscErrorCode XdmfMesh(Xdmf *xdmf)
{
  OutFile *file = &xdmf->file;

  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(file, "        <Topology TopologyType=\"%s\" NumberOfElements=\"%" PetscInt_FMT "\"%s>\n",
                         xdmf->element ? xdmf->element->xdmf : "Mixed", xdmf->n_cells,
                         xdmf->element && xdmf->element->n_nodes == 1 ? " NodesPerElement=\"1\"" : ""));
  PetscCall(XdmfItem(xdmf, "Int", sizeof(PetscInt), xdmf->n_ids + (xdmf->element ? 0 : xdmf->n_cells), 1,
                     xdmf->element ? "Connectivity" : "Mixed"));
  PetscCall(OutFilePrint(file, "        </Topology>\n        <Geometry GeometryType=\"XYZ\">\n"));
  PetscCall(XdmfItem(xdmf, "Float", sizeof(PetscReal), xdmf->n_nodes, 3, "Points"));
  PetscCall(OutFilePrint(
    file, "        </Geometry>\n        <Attribute Name=\"part\" AttributeType=\"Scalar\" Center=\"Cell\">\n"));
  PetscCall(XdmfItem(xdmf, "Int", sizeof(PetscInt), xdmf->n_cells, 1, "CellData/part"));
  PetscCall(OutFilePrint(file, "        </Attribute>\n"));
  PetscFunctionReturn(0);
}

/* Prints the beginning of a grid, with the mesh; no title for the mesh alone, time (s) NULL for the number of the
   grid */
PetscErrorCode XdmfGridBegin(Xdmf *xdmf, const char name[], const char title[], const PetscReal *time)
{
  OutFile *file = &xdmf->file;

  PetscFunctionBeginUser;
  xdmf->n_grids++;
  PetscCall(OutFilePrint(file, "      <Grid Name=\""));
  PetscCall(XdmfText(file, name));
  PetscCall(OutFilePrint(file, "\" GridType=\"Uniform\">\n"));
  if (title) PetscCall(XdmfInformation(file, "        ", "title", title));
  PetscCall(OutFilePrint(file, "        <Time Value=\"%.15g\"/>\n", time ? (double)*time : (double)xdmf->n_grids));
  PetscCall(XdmfMesh(xdmf));
  PetscFunctionReturn(0);
}

/* Prints an attribute at the nodes of the present grid: dataset PointData/`key``suffix`, width 1 or 3 */
PetscErrorCode XdmfNodal(Xdmf *xdmf, const char name[], const char key[], const char suffix[], PetscInt width)
{
  OutFile *file = &xdmf->file;
  char     path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(file, "        <Attribute Name=\""));
  PetscCall(XdmfText(file, name));
  PetscCall(OutFilePrint(file, "\" AttributeType=\"%s\" Center=\"Node\">\n", width == 1 ? "Scalar" : "Vector"));
  PetscCall(PetscSNPrintf(path, sizeof(path), "PointData/%s%s", key, suffix));
  PetscCall(XdmfItem(xdmf, "Float", sizeof(PetscReal), xdmf->n_nodes, width, path));
  PetscCall(OutFilePrint(file, "        </Attribute>\n"));
  PetscFunctionReturn(0);
}

/* Prints the end of the present grid */
PetscErrorCode XdmfGridEnd(Xdmf *xdmf)
{
  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(&xdmf->file, "      </Grid>\n"));
  PetscFunctionReturn(0);
}

/* Prints the end of the file */
PetscErrorCode XdmfEnd(Xdmf *xdmf)
{
  PetscFunctionBeginUser;
  if (xdmf->n_grids == 0) {
    PetscCall(XdmfGridBegin(xdmf, "mesh", NULL, NULL));
    PetscCall(XdmfGridEnd(xdmf));
  }
  PetscCall(OutFilePrint(&xdmf->file, "    </Grid>\n  </Domain>\n</Xdmf>\n"));
  PetscFunctionReturn(0);
}
