/*
   XDMF - the text beside the HDF5 file: a temporal collection with one grid per mode or state. Time is the number of
   the grid, and the attributes of modes have the same names in all grids, so that ParaView steps through them. All
   values are those of the group /VTKHDF of the HDF5 file. Reference: XDMF Model and Format, version 2.
*/
#include "resultsimpl.h"
#include <string.h>

/* Prints a string as the value of an XML attribute */
static PetscErrorCode XdmfText(OutFile *file, const char text[])
{
  static const char *const entities[][2] = {
    {"&",  "&amp;" },
    {"<",  "&lt;"  },
    {">",  "&gt;"  },
    {"\"", "&quot;"}
  };

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
static PetscErrorCode XdmfItem(ResultsField field, const char number[], size_t precision, PetscInt n, PetscInt width,
                               const char path[])
{
  OutFile *file = &field->xmf;

  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(
    file, "          <DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"%d\" Dimensions=\"%" PetscInt_FMT, number,
    (int)precision, n));
  if (width > 1) PetscCall(OutFilePrint(file, " %" PetscInt_FMT, width));
  PetscCall(OutFilePrint(file, "\">"));
  PetscCall(XdmfText(file, field->h5_name));
  PetscCall(OutFilePrint(file, ":/VTKHDF/%s</DataItem>\n", path));
  PetscFunctionReturn(0);
}

/* Prints the head of the file, with the names of the parts */
PetscErrorCode XdmfBegin(ResultsField field, PetscInt n_parts, const char *const parts[])
{
  OutFile *file = &field->xmf;
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
static PetscErrorCode XdmfMesh(ResultsField field)
{
  OutFile *file = &field->xmf;

  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(file, "        <Topology TopologyType=\"%s\" NumberOfElements=\"%" PetscInt_FMT "\">\n",
                         field->shape->xdmf, field->cells.n_global));
  PetscCall(XdmfItem(field, "Int", sizeof(PetscInt), field->cells.n_global * field->shape->n_nodes, 1, "Connectivity"));
  PetscCall(OutFilePrint(file, "        </Topology>\n        <Geometry GeometryType=\"XYZ\">\n"));
  PetscCall(XdmfItem(field, "Float", sizeof(PetscReal), field->nodes.n_global, 3, "Points"));
  PetscCall(OutFilePrint(
    file, "        </Geometry>\n        <Attribute Name=\"part\" AttributeType=\"Scalar\" Center=\"Cell\">\n"));
  PetscCall(XdmfItem(field, "Int", sizeof(PetscInt), field->cells.n_global, 1, "CellData/part"));
  PetscCall(OutFilePrint(file, "        </Attribute>\n"));
  PetscFunctionReturn(0);
}

/* Prints the beginning of a grid, with the mesh; no title for the mesh alone */
PetscErrorCode XdmfGridBegin(ResultsField field, const char name[], const char title[])
{
  OutFile *file = &field->xmf;

  PetscFunctionBeginUser;
  field->n_grids++;
  PetscCall(OutFilePrint(file, "      <Grid Name=\""));
  PetscCall(XdmfText(file, name));
  PetscCall(OutFilePrint(file, "\" GridType=\"Uniform\">\n"));
  if (title) PetscCall(XdmfInformation(file, "        ", "title", title));
  PetscCall(OutFilePrint(file, "        <Time Value=\"%" PetscInt_FMT "\"/>\n", field->n_grids));
  PetscCall(XdmfMesh(field));
  PetscFunctionReturn(0);
}

/* Prints an attribute at the nodes of the present grid: dataset PointData/`key``suffix`, width 1 or 3 */
PetscErrorCode XdmfNodal(ResultsField field, const char name[], const char key[], const char suffix[], PetscInt width)
{
  OutFile *file = &field->xmf;
  char     path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(file, "        <Attribute Name=\""));
  PetscCall(XdmfText(file, name));
  PetscCall(OutFilePrint(file, "\" AttributeType=\"%s\" Center=\"Node\">\n", width == 1 ? "Scalar" : "Vector"));
  PetscCall(PetscSNPrintf(path, sizeof(path), "PointData/%s%s", key, suffix));
  PetscCall(XdmfItem(field, "Float", sizeof(PetscReal), field->nodes.n_global, width, path));
  PetscCall(OutFilePrint(file, "        </Attribute>\n"));
  PetscFunctionReturn(0);
}

/* Prints the end of the present grid */
PetscErrorCode XdmfGridEnd(ResultsField field)
{
  PetscFunctionBeginUser;
  PetscCall(OutFilePrint(&field->xmf, "      </Grid>\n"));
  PetscFunctionReturn(0);
}

/* Prints the end of the file */
PetscErrorCode XdmfEnd(ResultsField field)
{
  PetscFunctionBeginUser;
  if (field->n_grids == 0) {
    PetscCall(XdmfGridBegin(field, "mesh", NULL));
    PetscCall(XdmfGridEnd(field));
  }
  PetscCall(OutFilePrint(&field->xmf, "    </Grid>\n  </Domain>\n</Xdmf>\n"));
  PetscFunctionReturn(0);
}
