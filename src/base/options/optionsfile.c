/*
   Options files, looked at before PETSc reads them: PETSc lets the last of two equal keys win, drops keys without a
   value, reads one document of several, and would wait for a pipe.

   YAML is read with libyaml, which PETSc reads it with too. A key is known by the option that it becomes, all keys
   above it in front: disc: {young: 1} and disc_young: 1 in one file are the same key twice. What a merge (<<) or an
   alias brings may be overridden, as YAML has it, and is not looked at.
*/
#include "yamlanchors.h"
#include "base/text.h"
#include <squeal/options.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <yaml.h>

#define MAX_SIZE  (16 << 20) /* bytes of an options file */
#define MAX_DEPTH 32
#define MAX_KEY   512
#define MAX_KEYS  10000 /* of a file */

/* A mapping or a list that is open */
typedef struct {
  PetscBool list, skipped; /* skipped: brought by a merge, or for the reader only ($$) */
  PetscBool wants_value;   /* of a mapping: its key has been read */
  size_t    prefix;        /* characters of the key that all keys in it begin with */
  PetscInt  n_items;       /* of a list */
} YamlLevel;

/* The file, and where it is read */
typedef struct {
  const char *file;
  size_t      line; /* of the present event, from 1 */
  PetscInt    depth, n_keys, n_documents;
  YamlLevel   level[MAX_DEPTH];
  char        key[MAX_KEY]; /* the present one, as the option without its dash */
  char      **keys;         /* all options that the file gives */
  size_t     *lines;        /* where */
  YamlAnchors anchors;      /* what aliases repeat */
} YamlFile;

/* Raises an error for an option that the file has already given */
static PetscErrorCode YamlAddKey(YamlFile *f)
{
  PetscBool same, is_file, is_yaml;
  char      option[MAX_KEY + 1] = "-";

  PetscFunctionBeginUser;
  PetscCall(TextAdd(option, f->key, sizeof(option)));
  PetscCall(OptionsNamesFile(option, &is_file, &is_yaml));
  PetscCheck(!is_file, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s:%zu: %s within an options file; give each file by -options_file on the command line", f->file, f->line,
             f->key);
  PetscCheck(f->n_keys < MAX_KEYS, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s:%zu: more than %d options in a file",
             f->file, f->line, MAX_KEYS);
  for (PetscInt i = 0; i < f->n_keys; i++) {
    PetscCall(PetscStrcasecmp(f->keys[i], f->key, &same)); /* PETSc's names ignore case */
    PetscCheck(!same, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s:%zu: %s stands twice, already in line %zu; keep one",
               f->file, f->line, f->key, f->lines[i]);
  }
  PetscCall(PetscRealloc((size_t)(f->n_keys + 1) * sizeof(*f->keys), &f->keys));
  PetscCall(PetscRealloc((size_t)(f->n_keys + 1) * sizeof(*f->lines), &f->lines));
  PetscCall(PetscStrallocpy(f->key, &f->keys[f->n_keys]));
  f->lines[f->n_keys++] = f->line;
  PetscFunctionReturn(0);
}

/* Raises an error for nothing as a value */
static PetscErrorCode YamlCheckValue(const YamlFile *f, const char value[])
{
  static const char *const nothing[] = {"", "~", "null", "Null", "NULL"};
  const char              *last      = &f->key[f->level[f->depth - 1].prefix];
  const PetscBool          is_number = last[0] && !last[strspn(last, "0123456789")] ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBeginUser;
  value += strspn(value, " \t\n");
  PetscCheck(value[0] || !is_number, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s:%zu: a value has a comma before %s: write 0.3 for 0,3, and several values in quotes, as \"0,3\"",
             f->file, f->line, last);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(nothing); i++)
    PetscCheck(strcmp(value, nothing[i]), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s:%zu: %s has no value; give one, or leave the key out", f->file, f->line, f->key);
  PetscFunctionReturn(0);
}

/* A key of the present mapping */
static PetscErrorCode YamlReadKey(YamlFile *f, const char text[])
{
  YamlLevel   *level  = &f->level[f->depth - 1];
  const size_t length = strlen(text);

  PetscFunctionBeginUser;
  PetscCheck(length > 0 && level->prefix + length + 2 < MAX_KEY, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s:%zu: a key must have 1 to %d characters", f->file, f->line, MAX_KEY - 2);
  PetscCall(PetscStrncpy(&f->key[level->prefix], text, MAX_KEY - level->prefix));
  level->wants_value = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* The present mapping or list got what it waited for */
static void YamlValueEnds(YamlFile *f)
{
  YamlLevel *level = f->depth ? &f->level[f->depth - 1] : NULL;

  if (!level) return;
  level->wants_value = PETSC_FALSE;
  level->n_items++;
}

static PetscBool YamlIsSkipped(const YamlFile *f)
{
  const YamlLevel *level = &f->level[f->depth - 1];
  const char      *key   = &f->key[level->prefix];

  return level->skipped || (!level->list && (!strcmp(key, "<<") || !strncmp(key, "$$", 2))) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode YamlReadScalar(YamlFile *f, const char text[])
{
  YamlLevel *level = f->depth ? &f->level[f->depth - 1] : NULL;

  PetscFunctionBeginUser;
  PetscCheck(level, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s:%zu: '%.40s' is no option; write NAME: VALUE", f->file,
             f->line, text);
  if (!level->list && !level->wants_value) {
    PetscCall(YamlReadKey(f, text));
    PetscFunctionReturn(0);
  }
  if (!YamlIsSkipped(f)) {
    PetscCall(YamlCheckValue(f, text));
    if (!level->list) PetscCall(YamlAddKey(f));
  }
  YamlValueEnds(f);
  PetscFunctionReturn(0);
}

/* A mapping or list begins, as the value of the present key */
static PetscErrorCode YamlOpen(YamlFile *f, PetscBool list)
{
  const YamlLevel *above = f->depth ? &f->level[f->depth - 1] : NULL;
  YamlLevel        level = {.list = list};

  PetscFunctionBeginUser;
  PetscCheck(f->depth < MAX_DEPTH, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s:%zu: more than %d levels", f->file,
             f->line, MAX_DEPTH);
  PetscCheck(above || !list, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s:%zu: a list is no option; write NAME: VALUE",
             f->file, f->line);
  PetscCheck(!above || above->list || above->wants_value, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s:%zu: a mapping or list is no key", f->file, f->line);
  if (above) level.skipped = YamlIsSkipped(f);
  PetscCheck(!above || !above->list || level.skipped, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s:%zu: the list %s holds a mapping or list; give values only", f->file, f->line, f->key);
  if (above && list && !level.skipped) PetscCall(YamlAddKey(f));
  level.prefix = strlen(f->key);
  if (above && !list) f->key[level.prefix++] = '_';
  f->key[level.prefix] = '\0';
  f->level[f->depth++] = level;
  PetscFunctionReturn(0);
}

static PetscErrorCode YamlClose(YamlFile *f)
{
  YamlLevel *level = &f->level[f->depth - 1];

  PetscFunctionBeginUser;
  f->key[level->prefix] = '\0';
  if (!level->list && level->prefix) f->key[level->prefix - 1] = '\0';
  PetscCheck(level->n_items || level->skipped || f->depth == 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s:%zu: %s has no value; give one, or leave the key out", f->file, f->line, f->key);
  f->depth--;
  YamlValueEnds(f);
  PetscFunctionReturn(0);
}

static PetscErrorCode YamlReadEvent(YamlFile *f, const yaml_event_t *event)
{
  YamlLevel *level = f->depth ? &f->level[f->depth - 1] : NULL;

  PetscFunctionBeginUser;
  f->line = event->start_mark.line + 1;
  switch (event->type) {
  case YAML_DOCUMENT_START_EVENT:
    PetscCheck(!f->n_documents++, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s:%zu: a second document begins, of which nothing would be read", f->file, f->line);
    break;
  case YAML_SCALAR_EVENT:
    PetscCall(YamlAnchorsAdd(&f->anchors, event->data.scalar.anchor, YAML_VALUE));
    PetscCall(YamlAnchorsCount(&f->anchors, f->file, f->line, 1));
    PetscCall(YamlReadScalar(f, (const char *)event->data.scalar.value));
    break;
  case YAML_MAPPING_START_EVENT:
    PetscCall(YamlAnchorsAdd(&f->anchors, event->data.mapping_start.anchor, f->depth));
    PetscCall(YamlOpen(f, PETSC_FALSE));
    break;
  case YAML_SEQUENCE_START_EVENT:
    PetscCall(YamlAnchorsAdd(&f->anchors, event->data.sequence_start.anchor, f->depth));
    PetscCall(YamlOpen(f, PETSC_TRUE));
    break;
  case YAML_MAPPING_END_EVENT:
  case YAML_SEQUENCE_END_EVENT:
    PetscCall(YamlClose(f));
    YamlAnchorsEnd(&f->anchors, f->depth);
    break;
  case YAML_ALIAS_EVENT:
    PetscCall(YamlAnchorsRepeat(&f->anchors, f->file, f->line, level && level->list && !YamlIsSkipped(f),
                                (const char *)event->data.alias.anchor));
    if (level && !level->list && level->wants_value && !YamlIsSkipped(f)) PetscCall(YamlAddKey(f));
    YamlValueEnds(f);
    break;
  default:
    break;
  }
  PetscFunctionReturn(0);
}

/* All events of the file */
static PetscErrorCode YamlReadEvents(YamlFile *f, yaml_parser_t *parser)
{
  PetscBool done = PETSC_FALSE;

  PetscFunctionBeginUser;
  while (!done) {
    yaml_event_t event;

    PetscCheck(yaml_parser_parse(parser, &event), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s:%zu: %s; check tabs, indentation, brackets and quotes of this YAML file", f->file,
               parser->problem_mark.line + 1, parser->problem ? parser->problem : "no YAML");
    done = event.type == YAML_STREAM_END_EVENT ? PETSC_TRUE : PETSC_FALSE;
    PetscCall(YamlReadEvent(f, &event));
    yaml_event_delete(&event);
  }
  PetscFunctionReturn(0);
}

/* The line of an option, and how many there are; the file is then no longer needed */
static PetscErrorCode YamlFinish(YamlFile *f, const char name[], size_t *line, PetscInt *n)
{
  PetscBool same;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < f->n_keys && name; i++) {
    PetscCall(PetscStrcasecmp(f->keys[i], name, &same));
    if (same) *line = f->lines[i];
  }
  *n = f->n_keys;
  for (PetscInt i = 0; i < f->n_keys; i++) PetscCall(PetscFree(f->keys[i]));
  PetscCall(PetscFree(f->keys));
  PetscCall(YamlAnchorsDestroy(&f->anchors));
  PetscCall(PetscFree(f->lines));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(0);
}

static PetscErrorCode YamlCheck(const char file[], FILE *stream, const char name[], size_t *found, PetscInt *n)
{
  YamlFile     *f;
  yaml_parser_t parser;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, &f));
  f->file = file;
  PetscCheck(yaml_parser_initialize(&parser), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory to read %s", file);
  yaml_parser_set_input_file(&parser, stream);
  PetscCall(YamlReadEvents(f, &parser));
  yaml_parser_delete(&parser);
  PetscCall(YamlFinish(f, name, found, n));
  PetscFunctionReturn(0);
}

/* Of PETSc's own form, -NAME VALUE line by line: raises an error for an option that stands in it twice */
static PetscErrorCode TextCheck(const char file[], FILE *stream, const char name[], size_t *found, PetscInt *n)
{
  YamlFile *f;
  char     *line = NULL;
  size_t    room = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, &f));
  f->file = file;
  for (f->line = 1; getline(&line, &room, stream) >= 0; f->line++) {
    const char  *option = line + strspn(line, " \t");
    const size_t length = strcspn(option, " \t\r\n");

    if (option[0] != '-' || length < 2 || length > MAX_KEY) continue;
    PetscCall(PetscStrncpy(f->key, option + 1, length));
    PetscCall(YamlAddKey(f));
  }
  free(line);
  PetscCall(YamlFinish(f, name, found, n));
  PetscFunctionReturn(0);
}

/* Whether PETSc reads a file as YAML: by its ending, or by how it begins */
static PetscErrorCode FileIsYaml(const char file[], FILE *stream, PetscBool *is_yaml)
{
  static const char *const endings[] = {".yaml", ".yml", ".json"};
  const char              *ending    = strrchr(file, '.');
  char                     first[6]  = "";
  const size_t             n         = fread(first, 1, sizeof(first) - 1, stream);

  PetscFunctionBeginUser;
  rewind(stream);
  PetscCheck(n < 2 || (memcmp(first, "\xff\xfe", 2) && memcmp(first, "\xfe\xff", 2)), PETSC_COMM_SELF,
             PETSC_ERR_USER_INPUT, "-options_file %s is in UTF-16; save it as UTF-8", file);
  if (!strncmp(first, "%YAML", 5) || !strncmp(first, "---", 3)) *is_yaml = PETSC_TRUE;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(endings) && ending && !*is_yaml; i++) {
    PetscCall(PetscStrcasecmp(ending, endings[i], is_yaml));
    PetscCheck(!*is_yaml || !strcmp(ending, endings[i]), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "-options_file %s: write its ending in small letters, '%s', or give it as -options_file_yaml", file,
               endings[i]);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsCheckFile(const char file[], PetscBool is_yaml)
{
  size_t   line;
  PetscInt n;

  PetscFunctionBeginUser;
  PetscCall(OptionsFindLine(file, is_yaml, NULL, &line, &n));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsFindLine(const char file[], PetscBool is_yaml, const char name[], size_t *line, PetscInt *n)
{
  struct stat what;
  FILE       *stream;

  PetscFunctionBeginUser;
  *line = 0;
  PetscCheck(!stat(file, &what), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "-options_file %s: %s", file, strerror(errno));
  PetscCheck(S_ISREG(what.st_mode), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "-options_file %s is no regular file; give a YAML file", file);
  PetscCheck(what.st_size <= MAX_SIZE, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "-options_file %s has %.3g MB, an options file at most %d", file, (double)what.st_size / 1e6,
             MAX_SIZE >> 20);
  stream = fopen(file, "rb");
  PetscCheck(stream, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "-options_file %s: %s", file, strerror(errno));
  PetscCall(FileIsYaml(file, stream, &is_yaml));
  if (is_yaml)
    PetscCall(YamlCheck(file, stream, name, line, n));
  else
    PetscCall(TextCheck(file, stream, name, line, n));
  (void)fclose(stream);
  PetscFunctionReturn(0);
}
