"""Why unstable modes grow: shares of friction and damping in the growth of each, modes_causes.csv."""

from ..tables import read_table
from .charts import Axis, Chart, Panel
from .markup import figure, figures, fixed, legend, signed

KINDS = {"mode": int, "cause": str, "kind": str, "growth_rad_s": float}
COLOURS = ("vermilion", "blue", "orange", "green", "purple", "sky", "steel")
SHOWN = 8  # unstable modes, fastest first
LEAST = 1e-3  # of the largest share of a mode: smaller ones are left out of the picture


def shares_of(path, unstable):
    """Mode -> (cause, kind) -> 1/s, of unstable modes."""
    found = {row["mode"]: {} for row in unstable}
    for row in read_table(path, KINDS):
        if row["mode"] in found:
            found[row["mode"]][row["cause"], row["kind"]] = row["growth_rad_s"]
    return found


def visible(shares):
    """The causes whose bars can be seen, the largest first."""
    largest = max(map(abs, shares.values()))
    return sorted((name for name in shares if abs(shares[name]) > LEAST * largest), key=lambda name: -abs(shares[name]))


def causes(modes, folder):
    """A bar for each cause of each unstable mode; nothing where no mode grows or a table of an older run has no causes."""
    path, rows = folder.path / "modes_causes.csv", modes.unstable[:SHOWN]
    if not path.exists() or not rows:
        return None
    found = shares_of(path, rows)
    found = {mode: {name: shares[name] for name in visible(shares)} for mode, shares in found.items() if shares}
    rows = [row for row in rows if row["mode"] in found]
    names = list(dict.fromkeys(name for row in rows for name in found[row["mode"]]))
    colour = {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(names)}
    values = [value for shares in found.values() for value in shares.values()]
    if not values:
        return None
    panel = Panel(Axis.about("share of the growth, 1/s", values, zero=True, room=0.08), 260)
    panel.rule(y=0, colour="ink")
    for i, row in enumerate(rows):
        shares, width = found[row["mode"]], 0.8 / max(len(found[row["mode"]]), 1)
        left = [i + 0.6 + k * width for k in range(len(shares))]
        panel.boxes([[x, x + 0.9 * width] for x in left], [[min(v, 0), max(v, 0)] for v in shares.values()],
                    [colour[name] for name in shares],
                    [f"mode {row['mode']}, {fixed(row['freq_hz'], 1)} Hz: {kind} {cause} {signed(value)} 1/s"
                     for (cause, kind), value in shares.items()])
        panel.label(i + 1, max(shares.values()), f"{fixed(row['freq_hz'], 0)} Hz, {signed(row['growth_rad_s'])} 1/s", "ink")
    keys = legend([(colour[name], "box", " ".join(reversed(name)).strip()) for name in names])
    x = Axis("unstable mode, fastest first", 0.4, len(rows) + 0.6)
    chart = Chart("share of each cause in the growth of the unstable modes", x, [panel]).markup(f"{folder.key}-why")
    more = f" Of {len(modes.unstable)} unstable modes the {SHOWN} fastest are shown." if len(modes.unstable) > SHOWN else ""
    return figure(f"{folder.key}-causes", "Why these modes grow", [keys, chart],
                  "The bars of a mode add up to its growth: what is above the line feeds it, what is below takes energy away. "
                  f"Bars below {figures(100 * LEAST)} % of the largest are left out." + more, folder.command("report"))
