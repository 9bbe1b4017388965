"""What small changes do to unstable modes: at a node or between two, modes_effects.csv, and of a parameter, modes_sensitivities.csv."""

from ..tables import header, optional, read_table
from .markup import Column, figures, fixed, signed, table, tag

KINDS = {"mode": int, "change": str, "part": str, **{f"direction_{axis}": float for axis in "xyz"},
         **{f"{axis}_m": float for axis in "xyz"}, "growth_rad_s_per_unit": float, "error_rad_s_per_unit": float, "unit": str,
         "first_order_units_to_zero": float}
BETWEEN = {"to_part": str, **{f"to_{axis}_m": optional for axis in "xyz"}}  # since there are changes between two nodes
EASY = {"kg": (1e-3, "g"), "N/m": (1e3, "N/mm"), "N s/m": (1, "N s/m")}  # amount of a small change, and its unit
SHOWN = 8  # unstable modes, fastest first
PARAMETERS = 6  # of a mode, with the largest effects
LEAST = 0.02  # of a direction: smaller components are left out of the words


def direction(row):
    """Along an axis, or the vector."""
    vector = [row[f"direction_{axis}"] for axis in "xyz"]
    if not any(vector):
        return "–"
    return "(" + ", ".join(fixed(0.0 if abs(x) < LEAST else x, 2) for x in vector) + ")"


def place(row, end=""):
    return ", ".join(figures(1e3 * row[f"{end}{axis}_m"], 4) for axis in "xyz")


def other_end(row):
    """Part and place, or the ground; a mass has none."""
    if row.get("to_part"):
        return f"{row['to_part']}: {place(row, 'to_')}"
    return "–" if row["change"] == "mass" else "ground"


def fewest(rows):
    """All changes at a node, and between two nodes the best of each kind and mode."""
    best = {}
    for row in rows:
        key = row["mode"], row["change"]
        if row.get("to_part") and (key not in best or row["first_order_units_to_zero"] < best[key]["first_order_units_to_zero"]):
            best[key] = row
    return [row for row in rows if not row.get("to_part") or best[row["mode"], row["change"]] is row]


def effects(modes, folder):
    """Rows of the fastest unstable modes; nothing where no mode grows or an older run has no such table."""
    path, unstable = folder.path / "modes_effects.csv", [row["mode"] for row in modes.unstable[:SHOWN]]
    if not path.exists() or not unstable:
        return None
    kinds = {**KINDS, **(BETWEEN if "to_part" in header(path) else {})}
    rows = fewest([row for row in read_table(path, kinds) if row["mode"] in unstable])
    if not rows:
        return None
    columns = [Column("mode", lambda row: row["mode"]),
               Column("change", lambda row: row["change"].replace("_", " "), left=True),
               Column("part", lambda row: row["part"], left=True),
               Column("place, mm", place, left=True),
               Column("other end", other_end, left=True),
               Column("direction", direction, left=True),
               Column("growth per unit, 1/s", lambda row: EASY[row["unit"]][0] * row["growth_rad_s_per_unit"],
                      lambda value: signed(value, 3)),
               Column("that would stop it", lambda row: row["first_order_units_to_zero"] / EASY[row["unit"]][0],
                      lambda value: figures(value, 3), hint="to first order"),
               Column("unit", lambda row: EASY[row["unit"]][1], left=True)]
    said = tag("p", "The mass, spring or dashpot that lowers the growth most, on each part, and where; of springs and dashpots between "
                    "two nodes the best one. All is to first order. scripts/cure tries such changes, and sets of them, and lists the "
                    "cheapest that leave no mode unstable.")
    return [tag("h4", "What a small change does"), said, table(f"{folder.key}-effects-table", columns, rows)]


def sensitivities(modes, folder):
    """Parameters with the largest effects on the fastest unstable modes; nothing without -modes_sensitivities."""
    path, unstable = folder.path / "modes_sensitivities.csv", [row["mode"] for row in modes.unstable[:SHOWN]]
    if not path.exists() or not unstable:
        return None
    kinds = {"mode": int, "parameter": str, "growth_rad_s_per_percent": float, "freq_hz_per_percent": float}
    found = [row for row in read_table(path, kinds) if row["growth_rad_s_per_percent"]]
    rows = [row for mode in unstable for row in sorted((row for row in found if row["mode"] == mode),
                                                       key=lambda row: -abs(row["growth_rad_s_per_percent"]))[:PARAMETERS]]
    if not rows:
        return None
    columns = [Column("mode", lambda row: row["mode"]),
               Column("parameter", lambda row: row["parameter"], left=True),
               Column("growth, 1/s per %", lambda row: row["growth_rad_s_per_percent"], lambda value: signed(value, 3)),
               Column("frequency, Hz per %", lambda row: row["freq_hz_per_percent"], lambda value: signed(value, 3))]
    said = tag("p", f"What one percent more of a parameter does, to first order, with the pairs as they are. The {PARAMETERS} that change "
                    "the growth most.")
    return [tag("h4", "What the parameters do"), said, table(f"{folder.key}-sensitivities-table", columns, rows)]
