"""What small changes do to unstable modes: at a node, modes_effects.csv, and of a parameter, modes_sensitivities.csv."""

from ..tables import read_table
from .markup import Column, figures, fixed, signed, table, tag

KINDS = {"mode": int, "change": str, "part": str, **{f"direction_{axis}": float for axis in "xyz"},
         **{f"{axis}_m": float for axis in "xyz"}, "growth_rad_s_per_unit": float, "error_rad_s_per_unit": float, "unit": str,
         "first_order_units_to_zero": float}
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


def place(row):
    return ", ".join(figures(1e3 * row[f"{axis}_m"], 4) for axis in "xyz")


def effects(modes, folder):
    """Rows of the fastest unstable modes; nothing where no mode grows or an older run has no such table."""
    path, unstable = folder.path / "modes_effects.csv", [row["mode"] for row in modes.unstable[:SHOWN]]
    if not path.exists() or not unstable:
        return None
    rows = [row for row in read_table(path, KINDS) if row["mode"] in unstable]
    if not rows:
        return None
    columns = [Column("mode", lambda row: row["mode"]),
               Column("change", lambda row: row["change"], left=True),
               Column("part", lambda row: row["part"], left=True),
               Column("place, mm", place, left=True),
               Column("direction", direction, left=True),
               Column("growth by it, 1/s", lambda row: EASY[row["unit"]][0] * row["growth_rad_s_per_unit"],
                      lambda value: signed(value, 3)),
               Column("per", lambda row: f"1 {EASY[row['unit']][1]}", left=True),
               Column("that would stop it", lambda row: row["first_order_units_to_zero"] / EASY[row["unit"]][0],
                      lambda value: figures(value, 3), hint="to first order"),
               Column("unit", lambda row: EASY[row["unit"]][1], left=True)]
    said = tag("p", "The mass, the spring to the ground or the dashpot that lowers the growth most, on each part, and where. All is "
                    "to first order: compute an amount that would stop the mode again, with it in the scene.")
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
