"""Why unstable modes grow: shares of friction and damping in the growth of each, modes_causes.csv; and which free modes of the bodies
they are made of, modes_components.csv."""

from ..tables import read_table
from .charts import Axis, Chart, Panel
from .markup import figure, figures, fixed, legend, signed

KINDS = {"mode": int, "cause": str, "kind": str, "growth_rad_s": float}
COLOURS = ("vermilion", "blue", "orange", "green", "purple", "sky", "steel")
SHOWN = 8  # unstable modes, fastest first
COMPONENT = 2.0  # %: smaller shares of free modes are left out
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


def bars(modes, found, words):
    """A chart of the shares of each unstable mode, found[mode][two names]; none without shares. `words` has the name of the axis, a
    format of a share in a tip, the title of the chart, and its key."""
    found = {mode: {name: shares[name] for name in visible(shares)} for mode, shares in found.items() if shares}
    rows = [row for row in modes.unstable[:SHOWN] if row["mode"] in found]
    names = list(dict.fromkeys(name for row in rows for name in found[row["mode"]]))
    colour = {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(names)}
    values = [value for shares in found.values() for value in shares.values()]
    if not values:
        return None
    panel = Panel(Axis.about(words["axis"], values, zero=True, room=0.08), 260)
    panel.rule(y=0, colour="ink")
    for i, row in enumerate(rows):
        shares, width = found[row["mode"]], 0.8 / max(len(found[row["mode"]]), 1)
        left = [i + 0.6 + k * width for k in range(len(shares))]
        panel.boxes([[x, x + 0.9 * width] for x in left], [[min(v, 0), max(v, 0)] for v in shares.values()],
                    [colour[name] for name in shares],
                    [f"mode {row['mode']}, {fixed(row['freq_hz'], 1)} Hz: {words['tip'](name, value)}" for name, value in shares.items()])
        panel.label(i + 1, max(shares.values()), f"{fixed(row['freq_hz'], 0)} Hz, {signed(row['growth_rad_s'])} 1/s", "ink")
    keys = legend([(colour[name], "box", words["name"](name)) for name in names])
    x = Axis("unstable mode, fastest first", 0.4, len(rows) + 0.6)
    return [keys, Chart(words["title"], x, [panel]).markup(words["key"])]


def beyond(modes):
    """What is not shown."""
    return f" Of {len(modes.unstable)} unstable modes the {SHOWN} fastest are shown." if len(modes.unstable) > SHOWN else ""


def causes(modes, folder):
    """A bar for each cause of each unstable mode; nothing where no mode grows or a table of an older run has no causes."""
    path = folder.path / "modes_causes.csv"
    if not path.exists() or not modes.unstable:
        return None
    picture = bars(modes, shares_of(path, modes.unstable[:SHOWN]),
                   {"axis": "share of the growth, 1/s", "key": f"{folder.key}-why",
                    "tip": lambda name, value: f"{name[1]} {name[0]} {signed(value)} 1/s",
                    "name": lambda name: " ".join(reversed(name)).strip(),
                    "title": "share of each cause in the growth of the unstable modes"})
    return picture and figure(f"{folder.key}-causes", "Why these modes grow", picture,
                              "The bars of a mode add up to its growth: what is above the line feeds it, what is below takes energy "
                              f"away. Bars below {figures(100 * LEAST)} % of the largest are left out." + beyond(modes),
                              folder.command("report"))


def components(modes, folder):
    """A bar for each free mode of each unstable mode; nothing where no free modes were found."""
    path = folder.path / "modes_components.csv"
    if not path.exists() or not modes.unstable:
        return None
    found = {row["mode"]: {} for row in modes.unstable[:SHOWN]}
    for row in read_table(path, {"mode": int, "body": str, "name": str, "share_percent": float}):
        if row["mode"] in found and abs(row["share_percent"]) >= COMPONENT:
            found[row["mode"]][row["body"], row["name"]] = row["share_percent"]
    picture = bars(modes, found,
                   {"axis": "share, %", "key": f"{folder.key}-made", "name": " ".join,
                    "tip": lambda name, value: f"{name[0]} {name[1]} {fixed(value, 1)} %",
                    "title": "share of each free mode in the unstable modes"})
    return picture and figure(f"{folder.key}-components", "Which free modes of the bodies they are made of", picture,
                              "Measured with left and right vectors. The largest bars of a mode that couples are those that merge. "
                              f"Bars below {figures(COMPONENT)} % are left out." + beyond(modes), folder.command("report"))
