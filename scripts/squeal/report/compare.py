"""Several folders side by side: what each says, the options in which they differ, eigenvalues of all modes together."""

from ..run.program import called
from ..tables import BadInput
from .charts import Axis, Chart, Panel
from .markup import Column, figure, fixed, legend, missing, section, signed, table, tag
from .modes import Modes, detail_of
from .origin import cost_of

COLOURS = ("blue", "orange", "green", "purple", "sky", "grey", "steel")
OWN = "sweep", "frf", "map", "cycle", "sample", "quiet", "design"  # analyses whose options begin with their name
SAME = 0.02  # modes of one label within this part of their frequency are one


def overview(folders, verdicts):
    """A row a folder."""
    columns = [Column("folder", lambda row: row[0].name, left=True),
               Column("analyses", lambda row: ", ".join(row[0].analyses), left=True),
               Column("result", lambda row: row[1], left=True),
               Column("time, s", lambda row: (cost_of(row[0]) or (0, float("nan"), 0))[1]),
               Column("memory, MB", lambda row: float((cost_of(row[0]) or (0, 0, float("nan")))[2]),
                      lambda v: fixed(v, 0))]
    return table("overview", columns, list(zip(folders, verdicts)))


def option_of(scene, name):
    """Its value where the analysis of the scene reads it."""
    kind, analysis = name.split("_")[0], scene.value("analysis", "modes")
    return "–" if kind in OWN and kind != analysis and name not in scene.given else scene.value(name, "–")


def differences(folders):
    """Options that are not the same everywhere."""
    scenes = [folder.scene for folder in folders if folder.scene]
    if len(scenes) < 2:
        return missing("No comparison of options: fewer than two folders have a scene.yaml.")
    names = sorted({name for scene in scenes for name in (*scene.given, *scene.defaults)})
    rows = [(name, [option_of(scene, name) for scene in scenes]) for name in names]
    rows = [row for row in rows if len(set(row[1])) > 1 and "–" not in row[1]]  # what only some read is no difference
    if not rows:
        return tag("p", "All options that they share are the same.")
    columns = [Column("option", lambda row: row[0], left=True)]
    columns += [Column(folder.name, lambda row, k=k: row[1][k], left=True)
                for k, folder in enumerate(folder for folder in folders if folder.scene)]
    return table("differences", columns, rows)


def eigenvalues(tables):
    """Growth against frequency, a colour a folder."""
    rows = [row for _, modes in tables for row in modes.rows]
    growth = [row["growth_rad_s"] for row in rows]
    panel = Panel(Axis.about("growth rate, 1/s", growth if max(map(abs, growth)) > 1e-3 else [-1, 1], True, 0.12), 300)
    panel.rule(y=0, colour="ink")
    for k, (folder, modes) in enumerate(tables):
        for bad, hollow, radius in ((False, " hollow", 3), (True, "", 6)):
            chosen = [row for row in modes.rows if row["unstable"] == bad]
            panel.points([1e-3 * row["freq_hz"] for row in chosen], [row["growth_rad_s"] for row in chosen],
                         COLOURS[k % len(COLOURS)] + hollow, [f"{folder.name}: {detail_of(row)}" for row in chosen],
                         radius)
    keys = legend([(COLOURS[k % len(COLOURS)], "dot", f"{folder.name} ({len(modes.unstable)} unstable)")
                   for k, (folder, modes) in enumerate(tables)])
    axis = Axis.about("frequency, kHz", [1e-3 * row["freq_hz"] for row in rows], room=0.03)
    chart = Chart("growth rate against frequency of all folders", axis, [panel]).markup("all-eigenvalues-chart")
    words = " ".join(folder.command("report").split(" ", 1)[1] for folder, _ in tables)
    return figure("all-eigenvalues", "Eigenvalues of all folders", [keys, chart], "Full dots are unstable.",
                  f"{called('report')} {words}")


def partner(row, modes):
    """The mode of that label nearest in frequency, of the same side of stability where there are two; None."""
    near = [other for other in modes.rows if other["label"] == row["label"] and
            abs(other["freq_hz"] - row["freq_hz"]) <= SAME * row["freq_hz"]]
    return min(near, key=lambda other: (abs(other["freq_hz"] - row["freq_hz"]),
                                        abs(other["growth_rad_s"] - row["growth_rad_s"])), default=None)


def unstable_table(tables):
    """Every mode that is unstable in some folder: its growth in all of them."""
    rows = []
    for _, modes in tables:
        for row in modes.unstable:
            if not any(known["label"] == row["label"] and abs(known["freq_hz"] / row["freq_hz"] - 1) <= SAME
                       for known in rows):
                rows.append(row)
    rows.sort(key=lambda row: row["freq_hz"])
    if not rows:
        return tag("p", "No mode is unstable in any folder.")

    def grows(row, modes):
        found = [other for other in modes.unstable if other["label"] == row["label"] and
                 abs(other["freq_hz"] / row["freq_hz"] - 1) <= SAME]
        return found[0]["growth_rad_s"] if found else 0.0 if partner(row, modes) else float("nan")

    columns = [Column("label", lambda row: row["label"], left=True),
               Column("freq, Hz", lambda row: row["freq_hz"], lambda v: fixed(v, 1))]
    columns += [Column(f"growth, 1/s: {folder.name}", lambda row, modes=modes: grows(row, modes), signed,
                       hint="0: the mode is there and does not grow; –: no mode of that label near")
                for folder, modes in tables]
    return table("all-unstable", columns, rows)


def compare_section(folders, verdicts):
    """All of it."""
    tables = []
    for folder in folders:
        try:
            if "modes" in folder.analyses:
                tables.append((folder, Modes(folder.path)))
        except BadInput:
            continue  # its own section says so
    tables = [(folder, modes) for folder, modes in tables if modes.rows]
    both = [eigenvalues(tables), tag("h4", "Unstable modes"), unstable_table(tables)] if len(tables) > 1 else None
    return tag("article", tag("h2", "Side by side"),
               section("compare", "Results", overview(folders, verdicts), tag("h4", "Options that differ"),
                       differences(folders), both), id="all")
