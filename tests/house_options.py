"""Options that texts of the program name: each must have a row, or be one of PETSc's and SLEPc's."""

import re

# A row begins with its name: {"-sweep_rtol", ...}, MATRIX("k", ...), VIEW(SHOWN_MODEL, "-model_view", ...), #define X "-name"
ROWS = re.compile(r'(?:\{[\s\\]*|[A-Z]\w*\((?:\w+,\s*)?|#define \w+\s+)"-(\w+)"')
NAMED = re.compile(r"(?:(?<=[\s('\"=,:])|^)-(?:(%s|\.\.\.|[A-Z]+)_)?([a-z]\w*)")
TEXT = re.compile(r'"(?:\\.|[^"\\\n])*"')
LIBRARIES = tuple("""bv_ ds_ eps_ info ksp_ log_ malloc mat_ memory on_error options_ pc_ pep_ rg_ sf_ snes_ st_ start_in ts_ vec_ version
    help skip_petscrc""".split())

OF_BOTH = {"max_it", "ncv"}  # of -%s_..., eps or pep


def rows_of(house):
    """Names of the rows of a house, without the dash; those of a list's records without the record's name."""
    return {name for source in house.c for name in ROWS.findall(source.text)}


def has_row(owner, name, rows):
    """Whether an option, perhaps of a record such as press_force, is that of a row; a row may end in the name of a matrix."""
    parts = name.split("_")
    if name[-1] == "_" and any(row.startswith(name) for row in rows):
        return True
    if owner and (name in OF_BOTH or any(row.endswith("_" + name) for row in rows)):
        return True
    return any("_".join(parts[k:]) in rows for k in range(len(parts))) or any(name.startswith(row) for row in rows if row[-1] == "_")


def named_without_row(house):
    """Each text that names an option without a row, and each list of options in a comment: source, place, option.
    What has no underscore and no owner may be a word."""
    rows = rows_of(house)
    for source in house.c:
        for listed in re.finditer("Options Database Keys", source.text):  # what PETSc's manual pages call a list of options
            yield source, listed.start(), "options beside their rows"
        bare = re.sub(r"/\*.*?\*/", lambda found: re.sub(r"[^\n]", " ", found[0]), source.text, flags=re.DOTALL)
        for text in TEXT.finditer(bare):
            for found in NAMED.finditer(text[0]):
                name = found[2]
                if (found[1] or "_" in name) and not name.startswith(LIBRARIES) and not has_row(found[1], name, rows):
                    yield source, text.start(), f"-{found[1] + '_' if found[1] else ''}{name}"
