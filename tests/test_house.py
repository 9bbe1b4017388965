#!/usr/bin/env python3
"""The rules of the house, by which each thing stands once and data flows one way:

  names      no type, macro, constant or function has one name twice in src and include, static functions included
  includes   a room includes only those below it (BELOW), a layer of the sweep only its own and lower ones (LAYERS), and
             nobody another room's private header (*impl.h)
  lengths    no file of src, include, scripts, tests above 400 lines, main.c not above 80, no function above 80, no
             function of C with more than six arguments
  folders    no folder of src has more than 15 files
  circles    at most 6 circles of files that call each other, none across rooms
  columns    no line of C beyond 120 columns but for texts, none of Python or the shell beyond 140
  strata     only src/model knows how a DMPlex numbers its points, only MatrixIsSymmetric() asks for a matrix's symmetry,
             only the chain names an analysis: what it does and uses, its row in chainrun.c says
  readmes    each folder of src has a README.md of at most 25 lines, or one above it that names the folder
  options    no option is read by two functions
  rows       an option is read by its row (include/squeal/quantity.h), but for UNROWED; each row has a help, a unit and a reader
  refusals   what a run does not read is refused by its row's condition, but for REFUSED, which says why not
  texts      no error and no help names an option that has no row; those of PETSc and SLEPc excepted; no header lists options
  unused     nothing of Python is imported or defined in vain: each function and class is named somewhere else
  dead       no function of C is kept alive by a test alone, but for public ones, and what one file uses is static
  words      nothing of who wrote it where: no paths of somebody's own folders, no day's work, no numbers of tasks

All violations are printed with file:line. The same rules then run on a small house with one violation of each kind
planted in it (PLANTED): a rule that finds nothing there would be no rule. Exit status: 0, or 1."""

import ast
import collections
import re
import sys
import tempfile
from pathlib import Path

from house import Script, Source, blank, together
from house_circles import circles_of
from house_options import named_without_row
from house_planted import PLANTED

MOST_FILE, MOST_MAIN, MOST_BODY, MOST_ARGUMENTS, MOST_README, MOST_COLUMNS, MOST_FILES, MOST_CIRCLES = \
    400, 80, 80, 6, 25, 140, 15, 6

CHAIN = ("base", "quantity", "kernels", "model", "contact", "sound", "operators", "solver", "basis", "statics", "modes", "sweep")
BELOW = {room: {*CHAIN[:k + 1], *(("results",) if k > 1 else ())} for k, room in enumerate(CHAIN)}
BELOW |= {room: BELOW["sweep"] | set(("sample", "quiet", "design")[:k + 1]) for k, room in enumerate(("sample", "quiet", "design"))}
BELOW |= {room: BELOW["modes"] | {room} | ({"dynamics"} if room == "reduced" else set()) for room in ("frf", "substructure", "reduced")}
BELOW["map"] = BELOW["reduced"] | {"map"}
BELOW |= {"results": {"base", "quantity", "kernels", "results"},
          "dynamics": {"base", "quantity", "kernels", "model", "contact", "sound", "operators", "statics", "results", "dynamics"}}
LAYERS = {"dense": {"dense"}, "basis": {"dense", "basis"}, "track": {"dense", "track"}}
# Public headers of which the name is not their room's
ROOM_OF_HEADER = {"checksum": "base", "cycle": "reduced", "contactstatus": "kernels", "elasticity": "kernels", "element": "kernels",
                  "joint": "kernels", "material": "kernels", "viscoelastic": "kernels", "mesh": "kernels", "options": "base",
                  "frictionlaw": "contact", "pressurelaw": "contact", "pencil": "operators", "projector": "contact", "sys": "base"}
# Signatures that a library lays down
LAID_DOWN = {"KeepError": "PetscPushErrorHandler()", "GroupKeepError": "PetscPushErrorHandler()",
             "DampedStop": "PEPSetStoppingTestFunction()", "UndampedStop": "EPSSetStoppingTestFunction()"}
ONLY = (r"src/model", re.compile(r"\b(DMPlexGet\w*Stratum|DMPlexGet(Vertex|Cell|Point)Numbering|DMGetStratum\w+|DM\w*Label\w*)\s*\(")), \
    (r"src/operators/files/matrixterm.c", re.compile(r"\b(MatIs(?:Symmetric|Hermitian|StructurallySymmetric))\s*\(")), \
    (r"include/squeal/quantity.h|src/chain", re.compile(r"\b(ANALYSIS_[A-Z]+)\b")), \
    (r"(?!src/scope)", re.compile(r"\b(RUN_(?:MODES|SWEEP|STATIC|TRANSIENT|FRF|MAP|CYCLE|CHECK))\b"))
# Options that are read without a row, and why
UNROWED = dict.fromkeys("skip_petscrc help help_list help_all help_json".split(), "asked by base/ before all else") | \
    dict.fromkeys("ts_dt eps_type pc_factor_mat_ordering_type".split(),
                  "PETSc's own: looked at, read by PETSc")
# Functions that refuse an option of the command line outside its row (OptionsRefuse*()), and what no row's condition can know
REFUSED = {"QuantitiesRefuse": "the rows themselves",
           "OptionsDropOf": "names of a list that is not there: they have no rows",
           "OptionsWarnUnused": "what PETSc has not read by the end of the run",
           "SolverReadFactorOptions": "PETSc's own that no solver here reads, before they are unknown",
           "SolverReadIterativeOptions": "PETSc's own, which only an iterative solver knows by name",
           "HistoryRound": "the end of the run in whole steps: the step is known with the mesh",
           "LateCheck": "the same; a restart may go on until it comes",
           "FindAll": "whether there is damping: the matrices tell"}
REALS = ("QUANTITY_REAL", "QUANTITY_REALS", "QUANTITY_LIST", "QUANTITY_MANY")
# Numbers without a unit, or with that of what they stand for
UNITLESS = set("""mu_factor axis frf_rtol rig_disc_spread poisson axis_1 axis_2 axis_3 cylinder_axis loss_factor spin_axis at
    thickness_axis dynamics_step_fraction contact_mu dense scale modes_components sweep_rtol sweep_percent slip map_rtol
    dynamics_growth_rtol cycle_rtol cycle_range cycle_amplitude superelement_rtol mu mu_static mu_kinetic operators_dense_k
    operators_dense_m operators_dense_c operators_dense_h ts_central_b pressure_m wear_exponent wear_settled zener_order table_temperature
    table_loss_factor sample_rtol mean deviation lower upper peak quiet_rtol quiet_tolerance quiet_lower quiet_upper design_rtol
    design_probability design_mass design_margin design_lower design_upper design_uncertain_lower design_uncertain_upper""".split())
OWN = re.compile(r"(?<![\w.>/}~-])/(work|home|root|Users|mnt)/|\b(this session|worktree|issue #?\d+|AI assistant)\b",
                 re.IGNORECASE)


class House:
    """The files below a root, each read once."""

    def __init__(self, root):
        self.root = root
        self.c = [Source(path) for top in ("src", "include") for path in sorted((root / top).rglob("*.[ch]"))]
        programs = {path: first_line(path) for path in self.files("src", "include", "scripts", "tests")}
        self.code = [path for path, first in programs.items() if path.suffix in (".c", ".h", ".py") or first[:2] == b"#!"]
        self.option_macros = {m[1]: m[2] for c in self.c for m in re.finditer(r'#define (\w+)\s+"-(\w+)"\n', c.text)}
        self.python = [Script(path) for path in self.code if path.suffix == ".py" or programs[path].endswith(b"python3")]

    def say(self, path, line, text):
        return f"{path.relative_to(self.root)}:{line}: {text}"

    def files(self, *tops):
        """Files of the folders, without what Python leaves."""
        return (path for top in tops for path in sorted((self.root / top).rglob("*"))
                if path.is_file() and "__pycache__" not in path.parts)


def first_line(path):
    """First line of a file, bytes."""
    with path.open("rb") as file:
        return file.readline(80).rstrip()


def room(path):
    """Room of a file of src or include, None where it stands above all."""
    if "include" in path.parts:
        return None if path.stem == "squeal" else ROOM_OF_HEADER.get(path.stem, path.stem)
    parts = path.parts[path.parts.index("src") + 1:]
    return parts[0] if len(parts) > 1 else None


def layer(path):
    """Layer of the sweep, "top", or None for other rooms."""
    if room(path) != "sweep" or "sweep" not in path.parts:
        return None
    folder = path.parts[path.parts.index("sweep") + 1]
    return folder if folder in LAYERS else "top"


def names(house):
    """What has one name twice."""
    seen = {}
    for source in house.c:
        of_file = [("function", f.name, f.line) for f in source.functions] + [tuple(name) for name in source.names]
        for kind, name, line in of_file:
            key = (kind if kind in ("struct", "union", "enum") else "", name)
            if key in seen:
                yield house.say(source.path, line, f"{kind} {name} stands at {seen[key]} too")
            seen.setdefault(key, f"{source.path.relative_to(house.root)}:{line}")


def included(house, path, name, quoted):
    """File of ours that an #include names, or None."""
    places = (path.parent, house.root / "src") if quoted else (house.root / "include",)
    return next((place / name for place in places if (place / name).is_file()), None)


def include_fault(house, path, name, quoted):
    """What is wrong with an #include in a file, or None."""
    target = included(house, path, name, quoted)
    if not target:
        return f"{name} is no file of ours" if quoted or name.startswith("squeal/") else None
    here, there = room(path), room(target)
    if here is None:
        return None
    if there is None or there not in BELOW.get(here, {here}):
        return f"{here} includes {name} of {there or 'all'}, which is above it or beside it"
    if layer(path) in LAYERS and there == "sweep" and layer(target) not in LAYERS[layer(path)]:
        return f"sweep/{layer(path)} includes {name} of sweep/{layer(target)}, which is above it or beside it"
    return f"{name} is private to {there}" if name.endswith("impl.h") and here != there else None


def includes(house):
    """What looks upward."""
    for source in house.c:
        for found in re.finditer(r'^#include ([<"])([^>"]+)[>"]', source.text, re.MULTILINE):
            fault = include_fault(house, source.path, found[2], found[1] == '"')
            if fault:
                yield house.say(source.path, source.line(found.start()), fault)


def lengths(house):
    """What is too long."""
    for path in house.code:
        n_lines = path.read_bytes().count(b"\n")
        if n_lines > MOST_FILE:
            yield house.say(path, n_lines, f"longer than {MOST_FILE} lines")
        if path.name == "main.c" and n_lines > MOST_MAIN:
            yield house.say(path, n_lines, f"longer than {MOST_MAIN} lines, a screen")
    for source in house.c:
        for f in source.functions:
            if f.n_lines > MOST_BODY:
                yield house.say(source.path, f.line, f"body of {f.name} has {f.n_lines} lines, more than {MOST_BODY}")
            if f.n_arguments > MOST_ARGUMENTS and f.name not in LAID_DOWN:
                said = f"{f.name} has {f.n_arguments} arguments, more than {MOST_ARGUMENTS}"
                yield house.say(source.path, f.line, said)
    for script in house.python:
        for f in script.definitions:
            if not isinstance(f, ast.ClassDef) and f.end_lineno - f.lineno > MOST_BODY:
                yield house.say(script.path, f.lineno, f"body of {f.name} has {f.end_lineno - f.lineno} lines, more than {MOST_BODY}")


def folders(house):
    """Folders that are too full."""
    held = collections.Counter(path.parent for path in house.files("src"))
    for folder, n_files in sorted(held.items()):
        if n_files > MOST_FILES:
            yield house.say(folder, 1, f"{n_files} files, more than {MOST_FILES}")


def circles(house):
    """Files that call each other in a loop: too many loops, or one across rooms."""
    found = circles_of(house.c)
    for circle in found:
        rooms = sorted({str(room(path)) for path in circle})
        if len(rooms) > 1:
            yield house.say(circle[0], 1, f"a circle of {', '.join(path.name for path in circle)} across {', '.join(rooms)}")
    if len(found) > MOST_CIRCLES:
        yield house.say(found[-1][0], 1, f"{len(found)} circles of files, more than {MOST_CIRCLES}")


def columns(house):
    """What is too wide."""
    for path in house.code:
        for n, line in enumerate(path.read_text().splitlines(), 1):
            most = MOST_COLUMNS - (20 if path.suffix in (".c", ".h") and "tests" not in path.parts and '"' not in line else 0)
            if len(line) > most:
                yield house.say(path, n, f"{len(line)} columns, more than {most}")


def strata(house):
    """What one place alone knows: how a DMPlex numbers its points; whether a matrix is symmetric, which each rank hears
    apart; which analyses there are."""
    for source in house.c:
        for place, pattern in ONLY:
            for found in () if re.match(place, str(source.path.relative_to(house.root))) else pattern.finditer(source.code):
                yield house.say(source.path, source.line(found.start()), f"{found[1]} outside of {place}")


def readmes(house):
    """Folders that nothing leads into."""
    for folder in sorted({path.parent for path in (house.root / "src").rglob("*.[ch]")} - {house.root / "src"}):
        readme, above = folder / "README.md", folder.parent / "README.md"
        if readme.is_file():
            n_lines = readme.read_text().count("\n")
            if n_lines > MOST_README:
                yield house.say(readme, n_lines, f"longer than {MOST_README} lines")
        elif not (above.is_file() and f"{folder.name}/" in above.read_text()):
            yield house.say(folder, 1, "no README.md, here or above, that says what it holds")


def read_options(house, source):
    """Option, its owner, function and line for each name, a text or a macro, that is handed to a function that reads it."""
    first = r'(?:[\w>.-]+(?:\([^)]*\))?, (NULL, |"\w+", )?)?'
    reader = re.compile(rf'\b(?!OptionsRefuse|OptionsDrop)(\w*Option\w*)\(\s*{first}(?:"-(\w+)"|([A-Z]\w+)\b)')
    for f in source.functions:
        for found in reader.finditer(source.text, f.begin, f.end):
            whose, name = (found[2] or "").strip('", '), found[3] or house.option_macros.get(found[4])
            if name:
                yield name, "" if whose == "NULL" else whose, f.name, source.line(found.end())


def options(house):
    """Options that two places read."""
    seen = {}
    for source in house.c:
        for name, whose, function, line in read_options(house, source):
            here = function, house.say(source.path, line, "")
            before = seen.setdefault((name, whose), here)
            if before[0] != function:
                yield f"{here[1]}-{name} is read at {before[1][:-2]} too"


ROW = re.compile(r'\{\s*"-(?P<name>\w+)",\s*(?P<help>(?:"[^"]*"\s*)+|NULL|\w+),\s*(?P<unit>NULL|"[^"]*"),\s*(?P<kind>QUANTITY_\w+)'
                 r'(?:,\s*(?P<at>\w+\((?:(?:struct )?\w+, )?[\w.]+))?')


def row_faults(row, words):
    """What a row lacks: a help, a unit, somebody who reads its member."""
    if row["help"].strip() in ('""', "NULL") and row["kind"] != "QUANTITY_PREFIX":
        yield "has no help"
    if row["unit"] == "NULL" and row["kind"] in REALS and row["name"] not in UNITLESS:
        yield "has no unit"
    if row["at"] and words[re.split(r"[(., ]", row["at"])[-1]] < 3:  # its struct, its row, and who reads it
        yield "is read by nobody"


def rows(house):
    """Options that are read without a row, rows that lack something, exceptions that nobody needs."""
    read = {}
    words = together(source.words for source in house.c)
    for source in house.c:
        for name, _, _, line in read_options(house, source):
            read[name] = house.say(source.path, line, f"-{name} is read without a row")
        for row in ROW.finditer(source.text):
            yield from (house.say(source.path, source.line(row.start()), f"-{row[1]} {fault}") for fault in row_faults(row, words))
    yield from (text for name, text in read.items() if name not in UNROWED)
    if len(read) > 2:  # a planted house reads few
        yield from (f"tests/test_house.py: -{name} of UNROWED is not read" for name in UNROWED if name not in read)


def refusals(house):
    """Options that are refused outside their rows, entries of the list that nobody needs."""
    found = {}
    for source in house.c:
        for f in source.functions:
            for call in re.finditer(r"\bOptionsRefuse\w*\(", source.code[f.begin:f.end]):
                found[f.name] = house.say(source.path, source.line(f.begin + call.start()), f"{f.name} refuses outside of rows")
    yield from (text for name, text in found.items() if name not in REFUSED)
    if len(found) > 2:
        yield from (f"tests/test_house.py: {name} of REFUSED refuses nothing" for name in REFUSED if name not in found)


def texts(house):
    """Errors and helps that name an option without a row."""
    for source, at, name in named_without_row(house):
        yield house.say(source.path, source.line(at), f"a text names {name}, which has no row" if name[0] == "-" else name)


def unused(house):
    """Python that nothing uses. What begins with handle_ the standard library calls."""
    named = collections.Counter(word for script in house.python for word in set(re.findall(r"\w+", script.text)))
    for script in house.python:
        for name, line in script.unused:
            yield house.say(script.path, line, f"{name} is imported in vain")
        own = collections.Counter(re.findall(r"\w+", script.text))
        for f in script.definitions:
            if named[f.name] == 1 and own[f.name] == 1 and not f.name.startswith(("__", "handle_")):
                yield house.say(script.path, f.lineno, f"nothing names {f.name}")


def dead(house):
    """Functions of C that no other file of the program names. Those that are static the compiler looks after."""
    own = {source.path: source.words for source in house.c}
    headers = together(named for path, named in own.items() if path.suffix == ".h")
    total = together(own.values())
    public = {word for path, named in own.items() if "include" in path.parts for word in named}
    tested = set(re.findall(r"\w+", " ".join(path.read_text() for path in house.files("tests") if path.suffix in (".c", ".h"))))
    for source in house.c:
        for f in source.functions:
            here = own[source.path][f.name]
            others = total[f.name] - here - (headers[f.name] if source.path.suffix == ".c" else 0)
            if f.name == "main" or others or (f.static and source.path.suffix == ".c"):
                continue
            if here == 1 and not (f.name in public & tested):
                yield house.say(source.path, f.line, f"{f.name} is dead: no file of the program names it")
            elif source.path.suffix == ".c" and f.name not in tested:
                yield house.say(source.path, f.line, f"{f.name} must be static: no other file names it")


def words(house):
    """What speaks of its author's folders or work."""
    tops = [top for top in ("src", "include", "scripts", "tests", "options") if (house.root / top).is_dir()]
    single = [path for path in (house.root / "README.md", house.root / "meson.build") if path.is_file()]
    for path in [*house.files(*tops), *single]:
        if path.suffix in (".png", ".pdf", ".h5") or path.samefile(__file__):
            continue
        for n, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
            if OWN.search(line):
                yield house.say(path, n, f"'{OWN.search(line)[0]}' is nobody's business here")


RULES = (names, includes, lengths, folders, circles, columns, strata, readmes, options, rows, refusals,
         texts, unused, dead, words)


def plant(files):
    """What each rule finds in a small house with these files: name of the rule -> violations."""
    with tempfile.TemporaryDirectory() as folder:
        kept = {"src/model/README.md": "", "src/modes/README.md": "", "src/model/c.c": "/* DMPlexGetDepthStratum( */\n",
                "scripts/c.py": "", "tests/c.py": "", "options/c.yaml": "", "include/squeal/model.h": ""}
        for name, text in (kept | files).items():
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        small = House(Path(folder))
        return {rule.__name__: list(rule(small)) for rule in RULES}


def missed():
    """Rules that do not find what is planted, or find more."""
    yield from (f"house without a fault: {name} finds {found}" for name, found in plant({}).items() if found)
    for rule, said, files in PLANTED:
        found = plant(files)
        if len(found[rule]) != 1 or said not in found[rule][0] or sum(map(len, found.values())) != 1:
            yield f"planted for {rule}, '{said}': found {found}"


def share_of_comments(house):
    """Lines of the .c files that hold a comment, or a part of one."""
    sources = [source for source in house.c if source.path.suffix == ".c"]
    lines = [(line, bare) for source in sources for line, bare in zip(
        source.text.split("\n"), re.sub(r"/\*.*?\*/", blank, source.text, flags=re.DOTALL).split("\n"))]
    return sum(line != bare for line, bare in lines) / max(len(lines), 1)


def main():
    house = House(Path(__file__).resolve().parents[1])
    found = {rule.__name__: list(rule(house)) for rule in RULES}
    for name, violations in found.items():
        print("\n".join([f"{name}: {len(violations)}", *violations]))
    for fault in missed():
        found["planted"] = [fault]
        print(fault)
    n_functions = sum(len(source.functions) for source in house.c)
    print(f"{len(house.c)} files, {n_functions} functions, {len(PLANTED)} planted faults, "
          f"{sum(source.text.count(chr(10)) for source in house.c)} lines of src and include, "
          f"comments in {100 * share_of_comments(house):.1f} % of those of .c files (15 wanted)")
    return 1 if any(found.values()) or n_functions < 1000 else 0


if __name__ == "__main__":
    sys.exit(main())
