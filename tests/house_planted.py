"""Small houses with one violation each, in which the rules of test_house.py must find it."""

# Files that break one rule each: rule, words of what it says, files
MANY = "static void Many(int a, int b, int c, int d,\n  int e, int f, int (*g)(int, int))\n{\n}\n"
MU = 'static void A(void)\n{\n  PetscOptionsReal("-ts_dt", "m", "a.h", m, &m, NULL);\n}\n'
MU_TOO = 'static void B(void)\n{\n  PetscOptionsGetReal(NULL, NULL, "-ts_dt", &m, NULL);\n}\n'
LAW = 'static void Law%s(void)\n{\n  OptionsGetReals(comm, "-eps_type", 1);\n}\n'
LOOP = "void %s(void)\n{\n  %s();\n}\n"


def loop(n):
    """Files of a circle of two in one folder, number n."""
    return {f"src/model/a{n}.c": LOOP % (f"A{n}", f"B{n}"), f"src/model/b{n}.c": LOOP % (f"B{n}", f"A{n}")}


PLANTED = (
    ("names", "function Twice", {"src/model/a.c": "static int Twice(void)\n{\n  return 1;\n}\n",
                               "src/modes/b.h": "int Twice(void)\n{\n  return 2;\n}\n"}),
    ("names", "type Grid", {"src/model/a.h": "typedef struct {\n  int n;\n} Grid;\n",
                          "src/modes/b.h": "typedef int Grid;\n"}),
    ("names", "struct Grid", {f"src/model/{k}.h": "struct Grid {\n  int n;\n};\n" for k in "ab"}),
    ("names", "macro EDGE", {"src/model/a.c": "#define EDGE 1\n", "src/modes/b.c": "#define EDGE 2\n"}),
    ("names", "constant OPEN", {"src/model/a.h": "typedef enum { OPEN } One;\n",
                              "src/modes/b.h": "typedef enum { SHUT, OPEN } Two;\n"}),
    ("includes", "model includes modes/b.h", {"src/model/a.c": '#include "modes/b.h"\n', "src/modes/b.h": ""}),
    ("includes", "model includes squeal/modes.h", {"src/model/a.c": "#include <squeal/modes.h>\n",
                                                 "include/squeal/modes.h": ""}),
    ("includes", "sweep/dense includes", {"src/sweep/dense/a.c": '#include "sweep/track/b.h"\n',
                                        "src/sweep/track/b.h": "", "src/sweep/README.md": "dense/ track/\n"}),
    ("includes", "sweep/basis includes", {"src/sweep/basis/a.c": '#include "sweep/b.h"\n', "src/sweep/b.h": "",
                                        "src/sweep/README.md": "basis/\n"}),
    ("includes", "is private", {"src/modes/a.c": '#include "model/modelimpl.h"\n', "src/model/modelimpl.h": ""}),
    ("includes", "is no file", {"src/modes/a.c": '#include "gone.h"\n'}),
    ("lengths", "longer than", {"scripts/a": "#!/bin/sh\n" + 400 * "\n"}), ("lengths", "longer than", {"tests/a.py": 401 * "\n"}),
    ("lengths", "a screen", {"src/main.c": 81 * "\n"}),
    ("lengths", "body of Long", {"src/model/a.c": "static void Long(void)\n{\n" + 81 * "  ;\n" + "}\n"}),
    ("lengths", "Many has 7 arguments", {"src/model/a.c": MANY}),
    ("lengths", "body of long", {"tests/a.py": "def long():\n" + 81 * "    pass\n" + "long()\n"}),
    ("folders", "16 files", {f"src/model/{k}.h": "" for k in range(14)}),
    ("circles", "across model, modes", {"src/model/a.c": LOOP % ("A", "B"), "src/modes/b.c": LOOP % ("B", "A")}),
    ("circles", "7 circles", {name: text for n in range(6) for name, text in loop(n).items()} |
     {"src/modes/a.c": LOOP % ("A", "B"), "src/modes/b.c": LOOP % ("B", "A")}),
    ("columns", "121 columns", {"src/model/a.c": "/*" + 117 * "a" + "*/\n"}),
    ("columns", "141 columns", {"scripts/a": "#!/bin/sh\n" + 141 * "#" + "\n"}),
    ("strata", "DMPlexGetDepthStratum", {"src/modes/a.c": "static void A(void)\n{\n  DMPlexGetDepthStratum(dm, 0);\n}\n"}),
    ("strata", "MatIsSymmetric outside", {"src/model/a.c": "static void A(void)\n{\n  MatIsSymmetric(A, 0, &same);\n}\n"}),
    ("strata", "ANALYSIS_MAP outside", {"src/modes/a.c": "static int A(void)\n{\n  return ANALYSIS_MAP;\n}\n"}),
    ("strata", "RUN_CHECK outside", {"src/scope.c": "static int A(void)\n{\n  return RUN_CHECK;\n}\n"}),
    ("readmes", "no README.md", {"src/solver/a.c": ""}),
    ("readmes", "longer than", {"src/model/README.md": 26 * "\n"}),
    ("options", "-ts_dt is read", {"src/model/a.c": MU, "src/modes/b.c": MU_TOO}),
    ("options", "-eps_type is read", {f"src/model/{k}.c": LAW % k for k in "ab"}),
    ("rows", "-mu is read without", {"src/model/a.c": MU.replace("ts_dt", "mu")}),
    ("rows", "-mu is read without", {"src/model/a.c": '#define MU "-mu"\n' + MU.replace('"-ts_dt"', "MU")}),
    ("rows", "-mu has no help", {"src/model/a.c": 'static const Quantity rows[] = {\n  {"-mu", "", NULL, QUANTITY_REAL},\n};\n'}),
    ("rows", "-force has no unit", {"src/model/a.c": 'static const Quantity rows[] = {\n  {"-force", "a", NULL, QUANTITY_REAL},\n};\n'}),
    ("rows", "-force is read by nobody", {"src/model/a.c": 'typedef struct {\n  double f;\n} Force;\nstatic const Quantity rows[] = {\n'
                                          '  {"-force", "a", "N", QUANTITY_REAL, FORCE(f)},\n};\n'}),
    ("refusals", "Own refuses outside", {"src/model/a.c": 'static int Own(void)\n{\n  return OptionsRefuse(comm, "-mu", "odd");\n}\n'}),
    ("texts", "names -modes_bnad", {"src/model/a.c": 'static const char why[] = "not used; give -modes_bnad";\n'}),
    ("texts", "options beside their rows", {"src/model/a.h": "/*\n   Options Database Keys:\n.  -modes_band <f1,f2> - Hz\n*/\n"}),
    ("unused", "nothing names gone", {"tests/a.py": "def gone():\n    pass\n"}),
    ("unused", "os is imported in vain", {"scripts/a": "#!/usr/bin/env python3\nimport os\nimport sys  # noqa: F401\n"}),
    ("dead", "Twice is dead", {"src/model/a.c": "int Twice(void)\n{\n  return 1;\n}\n", "src/model/a.h": "int Twice(void);\n",
                             "tests/a.c": "Twice();\n"}),
    ("dead", "Twice must be static", {"src/model/a.c": "int Twice(void)\n{\n  return 1 ? 1 : Twice();\n}\n"}),
    ("words", "nobody's business", {"options/a.yaml": "# see " + "/".join(("", "home", "me")) + "/notes\n"}),
)
