"""What would calm all modes, as scripts/cure has tried it: cure.csv of the folder's cure."""

from ..tables import optional, read_table
from .effects import direction, other_end, place
from .markup import Column, figures, signed, table, tag

KINDS = {"set": int, "cost": float, "n_unstable": int, "growth_rad_s": float, "growth_error_rad_s": float, "freq_hz": float,
         "change": str, "name": str, "part": str,
         **{f"{axis}_m": optional for axis in "xyz"}, **{f"direction_{axis}": float for axis in "xyz"},
         "amount": float, "to_part": str, **{f"to_{axis}_m": optional for axis in "xyz"}}
EASY = {"mass": (1e3, "g"), "spring": (1e-3, "N/mm"), "dashpot": (1.0, "N s/m"), "parameter": (1.0, "%")}  # of kg, N/m and N s/m
SHOWN = 10  # sets


def cures(folder):
    """The cheapest sets that leave no mode unstable, or those that leave least; nothing where none were tried since the run."""
    path, modes = folder.path / "cure/cure.csv", folder.path / "modes.csv"
    if not path.exists() or path.stat().st_mtime < modes.stat().st_mtime:
        return None
    rows = read_table(path, KINDS)
    stable = [row for row in rows if not row["n_unstable"]]
    chosen = sorted({row["set"] for row in stable or rows})[:SHOWN]
    shown = [row for row in rows if row["set"] in chosen]
    if not shown:
        return None

    def easy(row):
        return EASY[row["change"].removeprefix("relative_").removeprefix("layer_")]

    columns = [Column("set", lambda row: row["set"]),
               Column("cost", lambda row: row["cost"], lambda value: figures(value, 4)),
               Column("unstable", lambda row: row["n_unstable"]),
               Column("largest growth, 1/s", lambda row: row["growth_rad_s"], lambda value: signed(value, 4)),
               Column("its error, 1/s", lambda row: row["growth_error_rad_s"], lambda value: figures(value, 1)),
               Column("change", lambda row: row["change"].replace("_", " "), left=True),
               Column("amount", lambda row: easy(row)[0] * row["amount"], lambda value: figures(value, 4)),
               Column("unit", lambda row: easy(row)[1], left=True),
               Column("part", lambda row: row["part"], left=True),
               Column("over", lambda row: row["name"], left=True),
               Column("place, mm", lambda row: "" if row["name"] else place(row), left=True),
               Column("other end", other_end, left=True),
               Column("direction", direction, left=True)]
    count = len({row["set"] for row in rows})
    left = len({row["set"] for row in stable})
    said = tag("p", f"Of {count} sets of changes that scripts/cure tried on these modes {left} leave none unstable. "
                    + ("The cheapest:" if stable else "Those that leave least:")
                    + " rows of one number are made together. Compute the best one again, written into the mesh or the scene.")
    return [tag("h4", "What would stop all"), said, table(f"{folder.key}-cures-table", columns, shown)]
