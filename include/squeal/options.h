/*
   Options - what PETSc's options do not offer: lists of names that become prefixes, arrays of a given length, and
   errors that name the option.
*/
#pragma once

#include <petscviewer.h>

/* What PETSc hands to the setfromoptions of a type: a pointer to PetscOptionItems until 3.22, where the pointer itself
   got that name in 3.23 */
#if PETSC_VERSION_LT(3, 23, 0)
typedef PetscOptionItems *OptionsItems;
#else
typedef PetscOptionItems OptionsItems;
#endif

/*@
   OptionsGetNames - reads a list of names, each of which becomes the prefix of its own options. All lists of a scene
   share the prefixes: the table in options.c has them all, whichever room reads them. Collective.

   Input Parameters:
.  option - e.g. "-parts"
   Output Parameters:
+  n      - number of names
-  names  - array [n]; free it and each of them with PetscFree()

   Errors: PETSC_ERR_USER_INPUT for a name that is no identifier, stands twice, also in two lists, or is the prefix of
   other options.
@*/
PetscErrorCode OptionsGetNames(MPI_Comm comm, const char option[], PetscInt *n, char ***names);

/*@ OptionsTextAppend - puts text behind text, as much as there is room for: PetscStrlcat() writes beyond the end of one
    that is nearly full. Not collective. @*/
PetscErrorCode OptionsTextAppend(char text[], const char more[], size_t size);

/*@ OptionsCheckName - raises the error of OptionsGetNames() for a word that `option` gives as the name of an option of
   its
    own: it is no identifier, or other options begin with it or with what stands before its first underscore.
    Collective. @*/
PetscErrorCode OptionsCheckName(MPI_Comm comm, const char option[], const char name[]);

/*@
   OptionsDropUnlisted - a list on the command line, or in a later options file, stands in place of one in a file. What
   files say of a name that is then in no list is taken out, with a warning; it is an error where the command line says
   it. Collective; when every room has read its options.
@*/
PetscErrorCode OptionsDropUnlisted(MPI_Comm comm);

/*@ OptionsDropOf - the same of all options -`name`_... that nobody has read; `why` begins the warning, and ends the
   error.
    Collective. @*/
PetscErrorCode OptionsDropOf(MPI_Comm comm, const char name[], const char why[]);

/*@ OptionsDrop - takes out those of the options, "-modes_target -modes_count", that options files give and another
    option makes useless, each with a warning that ends in `why`. None where the command line gives one of them, which
    the condition of its row refuses. Collective. @*/
PetscErrorCode OptionsDrop(MPI_Comm comm, const char options[], const char why[]);

/*@
   OptionsGetReals - reads an array of exactly n numbers. Collective.

   Input Parameters:
+  option - e.g. "-hub_stiffness"
-  n      - length of the array, at most 15
   Output Parameters:
+  values - unchanged where the option is not given
-  set    - whether it is given, or NULL

   Errors: PETSC_ERR_USER_INPUT for more or fewer values.
@*/
PetscErrorCode OptionsGetReals(MPI_Comm comm, const char option[], PetscInt n, PetscReal values[], PetscBool *set);

/* Room for a list of numbers: one of the two, the other is NULL */
typedef struct {
  PetscInt   most;
  PetscReal *reals;
  PetscInt  *ints;
} OptionsRoom;

/*@ OptionsGetSome - reads a list of numbers; on return n of them, 0 where the option is not given, which changes none.
   Collective. Errors: PETSC_ERR_USER_INPUT for more than there is room for. @*/
PetscErrorCode OptionsGetSome(MPI_Comm comm, const char option[], const OptionsRoom *room, PetscInt *n);

/*@ OptionsGetInts - as OptionsGetReals(), integers. Collective. @*/
PetscErrorCode OptionsGetInts(MPI_Comm comm, const char option[], PetscInt n, PetscInt values[], PetscBool *set);

/*@ OptionsGetWords - reads a list of words, 0 where the option is not given. Collective. The caller frees the array [n]
   and
    each of them. @*/
PetscErrorCode OptionsGetWords(MPI_Comm comm, const char option[], PetscInt *n, char ***words);

/*@ OptionsGetItems - reads at most n names, without the blanks around them; where the option is not given nothing
    changes but n. Not collective. The caller frees them. @*/
PetscErrorCode OptionsGetItems(const char option[], PetscInt *n, char *items[], PetscBool *set);

/*@ ValuesSplit - the items of a list such as "a,b" without the blanks around them. Not collective, same call on all
    ranks; comm is that of errors. The caller frees them with PetscStrToArrayDestroy(). Errors: as
    ValuesCheckItems(). @*/
PetscErrorCode ValuesSplit(MPI_Comm comm, const char option[], const char text[], char separator, int *n,
                           char ***items);

/*@ ValuesCheckItems - raises an error for an empty item of a list, as "a,,b" and "a," have. Not collective, same call
    on all ranks. @*/
PetscErrorCode ValuesCheckItems(MPI_Comm comm, const char option[], const char text[], char separator);

/*@ ValuesParse - the values that the text of an option stands for: "first:last:n", equal steps,
    "first:last:n:log", equal ratios (is_log), or "v1,v2,...", ascending or descending. Not collective, same call on all
    ranks; comm is that of errors. The caller frees value. Errors: PETSC_ERR_USER_INPUT for other texts. @*/
PetscErrorCode ValuesParse(MPI_Comm comm, const char option[], const char text[], PetscInt *n, PetscReal *value[],
                           PetscBool *is_log);

/*@
   OptionsGetPath - reads the path of something to be read. Collective.

   A relative path in an options file begins at the folder of that file, and where there is nothing of that name, at the
   working folder, as one on the command line does. The option's value becomes the absolute path.

   Input Parameter:
.  option - e.g. "-model_mesh"
   Output Parameters:
+  path - of PETSC_MAX_PATH_LEN characters, with its folder; unchanged where the option is not given
-  set  - whether it is given, or NULL
@*/
PetscErrorCode OptionsGetPath(MPI_Comm comm, const char option[], char path[], PetscBool *set);

/*@
   OptionsGetViewer - reads where something is to be shown, in PETSc's words: "-modes_view" is stdout,
   "-modes_view ascii:modes.txt" a file, "-modes_view ascii:modes.txt::append" its end. Collective.

   Output Parameter:
.  viewer - NULL where the option is not given; else the caller destroys it

   Errors: PETSC_ERR_USER_INPUT for a viewer that is no text.
@*/
PetscErrorCode OptionsGetViewer(MPI_Comm comm, const char option[], PetscViewer *viewer);

/*@
   OptionsWithValue - names the options that give a value, or a list that holds it, for messages. Not collective.

   Input Parameters:
+  value   - of an option
-  endings - only options that end so, NULL at the end; NULL: any

   Output Parameter:
.  text - e.g. "-hub_set", or "-hub_set or -tip_set"; empty for none
@*/
PetscErrorCode OptionsWithValue(const char value[], const char *const endings[], char text[], size_t size);

/*@ OptionsFindGiven - the value of an option, NULL where it has none, without making it one that has been read. Not
   collective. @*/
PetscErrorCode OptionsFindGiven(const char option[], const char **value, PetscBool *given);

/*@ OptionsFindList - the list of the scene that holds a name, with its value, "-parts disc,pad", of a long one its
   number of
    names; empty for none. Not collective. @*/
PetscErrorCode OptionsFindList(const char name[], size_t size, char text[]);

/*@ ValueExplainUnit - what to write in place of a number with a unit, such as "210 GPa"; text is empty where it is no
   such number. Not collective. @*/
PetscErrorCode ValueExplainUnit(const char value[], char text[], size_t size);

/*@ OptionsFindLine - the line of an options file that gives an option, named without its dash; 0 for none. n is the
   number
    of options that the file gives. It has been checked by OptionsCheckFile(). Not collective. @*/
PetscErrorCode OptionsFindLine(const char file[], PetscBool is_yaml, const char name[], size_t *line, PetscInt *n);

/*@ OptionsFindLargest - the options file of the command line that gives the most options, "brake.yaml gives 600
   options"; empty
    for none. Not collective. @*/
PetscErrorCode OptionsFindLargest(char text[], size_t size);

/*@ OptionsFindPlace - for a message "FILE:LINE: " of the last options file of the command line that gives an option,
   named without
    its dash; empty where none does, or the command line itself. Not collective. @*/
PetscErrorCode OptionsFindPlace(const char name[], char text[], size_t size);

/*@
   OptionsExplainValue - rewrites PETSc's message about a value that is no number, integer or logical so that it names
   the option. Not collective.

   Output Parameter:
.  text - e.g. "-contact_mu: abc has no numeric value"; all options with that value; empty for other messages
@*/
PetscErrorCode OptionsExplainValue(const char message[], char text[], size_t size);

/*@
   OptionsNextGiven - takes the next option off the text of PetscOptionsGetAll(), as it is given: a value may hold
   blanks and what looks like another option. Nothing becomes used by it. Not collective.

   Input Parameter:
.  size - room of name
   Input/Output Parameter:
.  text - where the text goes on
   Output Parameters:
+  name  - without its dash
.  value - borrowed from PETSc; empty for none
-  more  - false at the end of the text; name and value are then not set
@*/
PetscErrorCode OptionsNextGiven(char **text, size_t size, char name[], const char **value, PetscBool *more);

/*@
   OptionsCheckArguments - looks at the command line and at the options files that it names, before SlepcInitialize().
   Not collective: all ranks read alike.

   Errors: PETSC_ERR_USER_INPUT for a word that is no option's value, an empty value, an options file that is none, for
   YAML the line of a fault, of a key that stands twice, or has no value.
@*/
PetscErrorCode OptionsCheckArguments(int argc, char *const argv[]);

/*@ OptionsMoveFiles - puts the options files before all other words, in their order: PETSc reads the command line from
    left to right, and what is typed on it is in force wherever it stands. As OptionsCheckArguments(), after it. @*/
PetscErrorCode OptionsMoveFiles(int argc, char *argv[]);

/*@ OptionsNamesFile - whether a word of the command line names an options file, and one of YAML whatever its ending.
   Not
    collective. @*/
PetscErrorCode OptionsNamesFile(const char name[], PetscBool *file, PetscBool *is_yaml);

/*@ OptionsCheckFile - the same for one options file; YAML by its ending, or where is_yaml says so. Not collective. @*/
PetscErrorCode OptionsCheckFile(const char file[], PetscBool is_yaml);

/*@ OptionsIsOwn - false where an option -a_2_b is not given, for which PETSc takes -a_b; true for any other name. Not
    collective. @*/
PetscErrorCode OptionsIsOwn(const char option[], PetscBool *own);

/*@ OptionsCheckNumbers - raises an error for nan, inf and what overflows to it, in the value of any option, whatever
    PETSc makes of it, and for a value of more than one line. Not collective: all ranks have the same options. @*/
PetscErrorCode OptionsCheckNumbers(void);

/*@ OptionsCheckNumber - the same for one option. Not collective. @*/
PetscErrorCode OptionsCheckNumber(const char option[]);

/*@ OptionsGetReal, OptionsGetInt - reads a number, unchanged where it is not given, as PetscOptionsGetReal() and
    PetscOptionsGetInt() do. Not collective, same call on all ranks. Errors: PETSC_ERR_USER_INPUT for words that PETSc
    takes for numbers, such as default, and integers that PetscInt does not hold. @*/
PetscErrorCode OptionsGetReal(MPI_Comm comm, const char option[], PetscReal *value, PetscBool *set);
PetscErrorCode OptionsGetInt(MPI_Comm comm, const char option[], PetscInt *value, PetscBool *set);

/*@ OptionsCheckWords - raises these errors for one option, or for an item of its array, before it is read otherwise.
   Not collective. @*/
PetscErrorCode OptionsCheckWords(MPI_Comm comm, const char option[], PetscBool integer);

/*@ OptionsGetBool - reads a logical option; without a value it is true. Not collective. @*/
PetscErrorCode OptionsGetBool(const char option[], PetscBool *value, PetscBool *set);

/*@ OptionsCheckValues - raises an error for an option of the program without a value, unless OptionsGetBool() or
    OptionsGetViewer() has read it, and for a list of numbers with an empty item. Collective; when every room has read
    its options. @*/
PetscErrorCode OptionsCheckValues(MPI_Comm comm);

/*@ OptionsRefuse - raises an error where one of the options, such as "-contact_kn -contact_law", stands on the command
    line; why ends the message. For what is read, and has no effect. Collective. @*/
PetscErrorCode OptionsRefuse(MPI_Comm comm, const char options[], const char why[]);

/*@ OptionsRefuseOf - the same of the options of one owner: "contact", "kn law". Collective. @*/
PetscErrorCode OptionsRefuseOf(MPI_Comm comm, const char owner[], const char names[], const char why[]);

/*@ OptionsDropBeside - OptionsDrop() of options of one owner, "kn kn_per_area", which -owner_choice with the word
    `chosen` does not read. Collective. @*/
PetscErrorCode OptionsDropBeside(MPI_Comm comm, const char owner[], const char names[], const char choice[],
                                 const char chosen[]);

/*@ OptionsRefusePrefix - the same of all options that begin so, such as "-pep_ -eps_". Collective. @*/
PetscErrorCode OptionsRefusePrefix(MPI_Comm comm, const char prefixes[], const char why[]);

/*@ OptionsCommandGives - whether the command line itself gives an option, whose name has no dash here. Not collective.
    @*/
PetscErrorCode OptionsCommandGives(const char name[], PetscBool *gives);

/*@ OptionsFilesGive - whether one of the options files of the command line gives an option, such as "-pad_density".
    Collective. @*/
PetscErrorCode OptionsFilesGive(MPI_Comm comm, const char option[], PetscBool *give);

/*@ OptionIsLibrarys - whether PETSc or SLEPc read an option, given without its dash. Not collective. @*/
PetscErrorCode OptionIsLibrarys(const char name[], PetscBool *is_librarys);

/*@ OptionsWarnUnused - one line on stderr for each option that nobody used until now, and an error for one that stands
    on the command line. Collective. @*/
PetscErrorCode OptionsWarnUnused(MPI_Comm comm);
