/*
   MeshReader of Gmsh files, formats 2.2 and 4.1, text and binary (Gmsh reference manual, "MSH file format").

   A file is a row of sections $Name ... $EndName. Formats differ in how an element finds its physical groups: 2.2
   writes one group with each element, and an element of two groups twice; 4.1 writes the groups with the geometric
   entity. Labels of PETSc's own reader are not used: it takes the elementary tag of 2.2 for a physical one, and in
   3.18 knows no curves.
*/
#include "gmsh.h"
#include "base/file.h"

#include <errno.h>

/* Bits of the corners around each node; elements of second order without nodes on faces take the first ones */
static const unsigned char at_tet[]   = {1, 2, 4, 8, 3, 6, 5, 9, 12, 10};
static const unsigned char at_prism[] = {1, 2, 4, 8, 16, 32, 3, 5, 9, 6, 18, 36, 24, 40, 48};
static const unsigned char at_hex[]   = {1,  2,   4,  8,   16, 32,  64, 128, 3,   9,   17,  6,   34, 12,
                                         68, 136, 48, 144, 96, 192, 15, 51,  153, 102, 204, 240, 255};

static const GmshShape shapes[] = {
  {15, 0, 1, 1, DM_POLYTOPE_POINT, NULL},          {1, 1, 2, 2, DM_POLYTOPE_SEGMENT, NULL},
  {2, 2, 3, 3, DM_POLYTOPE_TRIANGLE, NULL},        {3, 2, 4, 4, DM_POLYTOPE_QUADRILATERAL, NULL},
  {4, 3, 4, 4, DM_POLYTOPE_TETRAHEDRON, at_tet},   {5, 3, 8, 8, DM_POLYTOPE_HEXAHEDRON, at_hex},
  {6, 3, 6, 6, DM_POLYTOPE_TRI_PRISM, at_prism},   {8, 1, 2, 3, DM_POLYTOPE_SEGMENT, NULL},
  {9, 2, 3, 6, DM_POLYTOPE_TRIANGLE, NULL},        {16, 2, 4, 8, DM_POLYTOPE_QUADRILATERAL, NULL},
  {10, 2, 4, 9, DM_POLYTOPE_QUADRILATERAL, NULL},  {11, 3, 4, 10, DM_POLYTOPE_TETRAHEDRON, at_tet},
  {17, 3, 8, 20, DM_POLYTOPE_HEXAHEDRON, at_hex},  {12, 3, 8, 27, DM_POLYTOPE_HEXAHEDRON, at_hex},
  {18, 3, 6, 15, DM_POLYTOPE_TRI_PRISM, at_prism},
};

/* Names of types that are not read, and what to do about them */
static const struct {
  PetscInt    type;
  const char *what;
} refused[] = {
  {7, "5-node pyramids are not supported; mesh with tetrahedra where hexahedra and tetrahedra meet"},
  {13, "18-node wedges are not supported; mesh with Mesh.SecondOrderIncomplete = 1 for those of 15 nodes"},
  {14, "14-node pyramids are not supported; mesh with tetrahedra"},
  {19, "13-node pyramids are not supported; mesh with tetrahedra"},
};

/* What opens $Nodes and $Elements: the number of items, and in format 4.1 of blocks (then smallest and largest tag)
   */
static PetscInt ReadHeader(MeshReader *r, PetscInt *n_blocks)
{
  PetscInt n;

  *n_blocks = 0;
  if (r->version == 22) return ReadCountLine(r);
  *n_blocks = ReadCount(r, SIZE_BYTES);
  n         = ReadCount(r, SIZE_BYTES);
  for (int skip = 0; skip < 2; skip++) (void)ReadInteger(r, SIZE_BYTES);
  return n;
}

static const GmshShape *ReadShape(MeshReader *r)
{
  const PetscInt type = ReadTag(r, INT_BYTES);

  for (size_t s = 0; s < PETSC_STATIC_ARRAY_LENGTH(shapes); s++) {
    if (shapes[s].type == type) return &shapes[s];
  }
  for (size_t s = 0; s < PETSC_STATIC_ARRAY_LENGTH(refused); s++) {
    if (refused[s].type == type) ReaderErrorSet(r->error, PETSC_ERR_SUP, "%s", refused[s].what);
  }
  ReaderErrorSet(r->error, PETSC_ERR_SUP,
                 "elements of type %" PetscInt_FMT " are not supported; those of first and second order are", type);
  return &shapes[0];
}

/* $MeshFormat: version, kind and size of numbers; binary files add the integer 1 */
static PetscErrorCode ReadFormat(MeshReader *r, GmshMesh *mesh)
{
  char   line[64] = "";
  double version  = 0;
  int    binary = 0, bytes = 0;

  PetscFunctionBeginUser;
  (void)mesh;
  if (!fgets(line, sizeof(line), r->file) || sscanf(line, "%lf %d %d", &version, &binary, &bytes) != 3 ||
      (binary != 0 && binary != 1)) {
    ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "the file has no valid $MeshFormat");
  }
  r->version = (PetscInt)(10 * version + 0.5);
  r->binary  = binary ? PETSC_TRUE : PETSC_FALSE;
  if ((r->version != 22 && r->version != 41) || bytes != SIZE_BYTES) {
    ReaderErrorSet(
      r->error, PETSC_ERR_SUP,
      "format %.6g with numbers of %d bytes is unsupported; 2.2 and 4.1 with 8 bytes are (Mesh.MshFileVersion)",
      version, bytes);
  }
  if (r->binary && ReadInteger(r, INT_BYTES) != 1) {
    ReaderErrorSet(r->error, PETSC_ERR_SUP, "the file was written with another byte order; write it here, or as text");
  }
  PetscFunctionReturn(0);
}

/* Nodes of one entity (4.1): dimension and tag of the entity, whether parameters follow x, y, z, count, all tags,
   all coordinates */
static PetscInt ReadNodeBlock(MeshReader *r, GmshMesh *mesh, PetscInt first)
{
  const PetscInt dim = ReadTag(r, INT_BYTES), tag = ReadTag(r, INT_BYTES), parametric = ReadTag(r, INT_BYTES);
  const PetscInt n = ReadCount(r, SIZE_BYTES);
  PetscReal      parameter[3];

  if (n > mesh->n_nodes - first || dim < 0 || dim > 3) {
    ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "entity %" PetscInt_FMT " exceeds the number of $Nodes", tag);
    return first;
  }
  for (PetscInt i = first; i < first + n; i++) mesh->node_tags[i] = ReadTag(r, SIZE_BYTES);
  for (PetscInt i = first; i < first + n; i++) {
    ReadReals(r, 3, mesh->x + 3 * i);
    ReadReals(r, parametric ? dim : 0, parameter);
  }
  return first + n;
}

static PetscErrorCode ReadNodes(MeshReader *r, GmshMesh *mesh)
{
  PetscInt n_blocks, read = 0;

  PetscFunctionBeginUser;
  mesh->n_nodes = ReadHeader(r, &n_blocks);
  PetscCall(PetscMalloc2(mesh->n_nodes, &mesh->node_tags, 3 * mesh->n_nodes, &mesh->x));
  for (PetscInt b = 0; b < n_blocks && !r->error->code; b++) read = ReadNodeBlock(r, mesh, read);
  for (; r->version == 22 && read < mesh->n_nodes && !r->error->code; read++) {
    mesh->node_tags[read] = ReadTag(r, INT_BYTES);
    ReadReals(r, 3, mesh->x + 3 * read);
  }
  if (read < mesh->n_nodes) ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "$Nodes holds less than it announces");
  PetscFunctionReturn(0);
}

/* Nodes of format 2.2 with Mesh.SaveParametric: dimension and tag of their entity follow x, y, z, then the parameters
   on a curve or surface */
static PetscErrorCode ReadParametricNodes(MeshReader *r, GmshMesh *mesh)
{
  PetscReal parameter[3];

  PetscFunctionBeginUser;
  mesh->n_nodes = ReadCountLine(r);
  PetscCall(PetscMalloc2(mesh->n_nodes, &mesh->node_tags, 3 * mesh->n_nodes, &mesh->x));
  for (PetscInt i = 0; i < mesh->n_nodes && !r->error->code; i++) {
    PetscInt dim;

    mesh->node_tags[i] = ReadTag(r, INT_BYTES);
    ReadReals(r, 3, mesh->x + 3 * i);
    dim = ReadTag(r, INT_BYTES);
    (void)ReadTag(r, INT_BYTES);
    ReadReals(r, dim == 1 || dim == 2 ? dim : 0, parameter);
  }
  PetscFunctionReturn(0);
}

/* Elements of format 2.2: number, type, tags (the first is the physical group), nodes; binary files hold blocks of
   one type */
static void ReadElements22(MeshReader *r, GmshMesh *mesh)
{
  for (PetscInt e = 0; e < mesh->n_elements && !r->error->code;) {
    PetscInt         number = r->binary ? 0 : ReadTag(r, INT_BYTES);
    const GmshShape *shape  = ReadShape(r);
    const PetscInt   last = e + (r->binary ? ReadCount(r, INT_BYTES) : 1), n_tags = ReadCount(r, INT_BYTES);

    if (last == e || last > mesh->n_elements) {
      ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "a block of $Elements is empty or longer than announced");
    }
    for (; e < last && !r->error->code; e++) {
      GmshElement *element  = &mesh->elements[e];
      PetscInt     physical = 0;

      if (r->binary) number = ReadTag(r, INT_BYTES);
      for (PetscInt t = 0; t < n_tags; t++) {
        const PetscInt tag = ReadTag(r, INT_BYTES);

        if (t == 0) physical = PetscAbsInt(tag);
      }
      *element = (GmshElement){.shape = shape, .number = number, .entity = GmshFindEntity(mesh, shape->dim, physical)};
      for (PetscInt v = 0; v < shape->n_nodes; v++) element->node[v] = ReadTag(r, INT_BYTES);
    }
  }
}

/* Elements of format 4.1: blocks of one entity and type; number and nodes of each */
static void ReadElements41(MeshReader *r, GmshMesh *mesh, PetscInt n_blocks)
{
  PetscInt e = 0;

  for (PetscInt b = 0; b < n_blocks && !r->error->code; b++) {
    const PetscInt   dim = ReadTag(r, INT_BYTES), tag = ReadTag(r, INT_BYTES), entity = GmshFindEntity(mesh, dim, tag);
    const GmshShape *shape = ReadShape(r);
    const PetscInt   last  = e + ReadCount(r, SIZE_BYTES);

    if (entity < 0 && mesh->n_entities)
      ReaderErrorSet(r->error, PETSC_ERR_FILE_READ,
                     "$Elements has entity %" PetscInt_FMT " of dimension %" PetscInt_FMT
                     ", which $Entities does not hold",
                     tag, dim);
    if (last > mesh->n_elements)
      ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "$Elements holds more than it announces");
    for (; e < last && !r->error->code; e++) {
      mesh->elements[e] = (GmshElement){.shape = shape, .number = ReadTag(r, SIZE_BYTES), .entity = entity};
      for (PetscInt v = 0; v < shape->n_nodes; v++) mesh->elements[e].node[v] = ReadTag(r, SIZE_BYTES);
    }
  }
  if (e < mesh->n_elements) ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "$Elements holds less than it announces");
}

static PetscErrorCode ReadElements(MeshReader *r, GmshMesh *mesh)
{
  PetscInt n_blocks;

  PetscFunctionBeginUser;
  mesh->n_elements = ReadHeader(r, &n_blocks);
  PetscCall(PetscMalloc1(mesh->n_elements, &mesh->elements));
  if (r->version == 41)
    ReadElements41(r, mesh, n_blocks);
  else
    ReadElements22(r, mesh);
  PetscFunctionReturn(0);
}

static const struct {
  const char *name;
  PetscErrorCode (*read)(MeshReader *, GmshMesh *);
} sections[] = {
  {"MeshFormat", ReadFormat},     {"PhysicalNames", GmshReadNames},
  {"Entities", GmshReadEntities}, {"PartitionedEntities", GmshReadPartitionedEntities},
  {"Nodes", ReadNodes},           {"ParametricNodes", ReadParametricNodes},
  {"Elements", ReadElements},
};

/* Reads the section whose first line has just been read, up to its end; behind $Elements only looks whether one of
   these stands in the file again */
static PetscErrorCode ReadSection(MeshReader *r, const char line[], GmshMesh *mesh)
{
  PetscBool known = PETSC_FALSE;

  PetscFunctionBeginUser;
  sscanf(line, "$%31s", r->section);
  for (size_t s = 0; s < PETSC_STATIC_ARRAY_LENGTH(sections); s++) {
    if (!strncmp(r->section, "End", 3) && !strcmp(r->section + 3, sections[s].name))
      ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "a line $%s ends no section", r->section);
    if (strcmp(r->section, sections[s].name)) continue;
    if (r->seen & 1U << s) ReaderErrorSet(r->error, PETSC_ERR_FILE_READ, "section $%s stands twice", r->section);
    known = PETSC_TRUE;
    r->seen |= 1U << s;
    if (!r->error->code) PetscCall(sections[s].read(r, mesh));
  }
  if (known || !mesh->elements) ReadSectionEnd(r, known);
  PetscFunctionReturn(0);
}

PetscErrorCode GmshMeshRead(const char file[], GmshMesh *mesh, ReaderError *error)
{
  MeshReader r        = {.error = error};
  char       line[64] = "";

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(mesh, sizeof(*mesh)));
  PetscCall(PetscMemzero(error, sizeof(*error)));
  r.file = FileStream(file, "rb");
  if (!r.file || fseek(r.file, 0, SEEK_END))
    ReaderErrorSet(error, PETSC_ERR_FILE_OPEN, "%s", FileReason(errno));
  else
    r.most = PetscMin(ftell(r.file), PETSC_MAX_INT / 32);
  if (r.file) rewind(r.file);
  while (!error->code && fgets(line, sizeof(line), r.file)) {
    if (line[0] == '$')
      PetscCall(ReadSection(&r, line, mesh));
    else if (!r.version)
      ReaderErrorSet(error, PETSC_ERR_FILE_READ,
                     "the file does not begin with $MeshFormat, as those of Gmsh do; scripts/import brings in others");
    else if (!mesh->elements && line[strspn(line, " \t\r\n")])
      ReaderErrorSet(error, PETSC_ERR_FILE_READ, "behind section $%s a line stands in no section", r.section);
  }
  if (r.file && ferror(r.file)) ReaderErrorSet(error, PETSC_ERR_FILE_READ, "%s", strerror(errno)); /* as of a folder */
  if (r.file) fclose(r.file);
  if (!mesh->n_elements) ReaderErrorSet(error, PETSC_ERR_FILE_READ, "the file holds no elements");
  PetscFunctionReturn(0);
}

PetscErrorCode GmshMeshDestroy(GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(mesh->groups));
  PetscCall(PetscFree(mesh->entities));
  PetscCall(PetscFree2(mesh->node_tags, mesh->x));
  PetscCall(PetscFree(mesh->elements));
  PetscFunctionReturn(0);
}
