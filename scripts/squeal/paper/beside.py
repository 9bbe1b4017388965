"""The part of the page that has the seed paper beside what comes out here, and the page."""

import math

from ..run.kept_runs import LOG
from ..report.charts import Axis, Chart, Panel
from ..report.films import diameters_figure
from ..report.folders import Folder, Options
from ..report.markup import Column, count, figure, legend, missing, section, table, tag
from ..report.origin import cost_of
from ..report.page import Opening, write_page
from ..report.sweeps import line_figure
from ..report.transients import Record, force_figures, growth_figure, signal_figure, spectrum_figure
from ..sweep.tables import Study
from ..modes.table1 import RESOLUTION, TABLE
from ..tables import BadInput, flag, read_table
from ..transient.history import snapshots
from . import claims
from .plan import FIGURES, chosen_runs
from .shapes import mode_shape, moving_shape, peak_shape

MODES = {"mode": int, "freq_hz": float, "growth_rad_s": float, "unstable": flag, "label": str}
VERDICT = {True: "as in the paper", False: "NOT as in the paper", None: ""}
COLOURS = "blue", "orange", "green", "purple"
TUNED = ("Figures 7 to 11 are with rows of springs, damping and speed that the paper does not state: they were tuned "
         "so that its three regimes come out; 1 mm of the rows changes them. The second sweep of Figure 5 is fitted "
         "to the paper's onsets, and gets no verdict.")
RULE = (f"A frequency, or the rms difference of several, is as in the paper where it is off by less than "
        f"{100 * claims.CLOSE:g} %, an onset by less than {100 * claims.NEAR:g} %. The normal force does not oscillate "
        f"remarkably where it stays within {100 * claims.QUIET:g} % of its mean from least to largest. Of shapes the "
        "number of nodal diameters counts.")
TITLE = "The seed paper beside what comes out here"


class Place:
    """The folder of all runs, those that are complete, and whether each claim came out as in the paper."""

    def __init__(self, root, runs):
        self.root, self.runs, self.verdicts = root, runs, []
        self.made = {run.name for run in runs if (root / run.name / LOG).exists()}

    def folder(self, name, key):
        """A run for the pictures of one figure: `key` begins the names of their elements."""
        if name not in self.made:
            raise BadInput(f"{self.root / name}: this run is not complete")
        return Folder(self.root / name, key, Options(probe="edge"))

    def path(self, name):
        """Folder of a run; None where it is not complete."""
        return self.root / name if name in self.made else None

    def claims(self, name, found):
        """Claims in rows; on a narrow screen each is a paragraph."""
        def cells(claim):
            return [tag("b", claim.what), tag("span", claim.paper, data_of="paper"),
                    tag("span", claim.here, data_of="here"), tag("i", VERDICT[claim.kept])]

        found = list(found)
        self.verdicts += [claim.kept for claim in found if claim.kept is not None]
        head = tag("li", tag("b", ""), tag("span", "paper"), tag("span", "here"), tag("i", ""), class_="head")
        rows = [tag("li", cells(claim), class_={True: "good", False: "other"}.get(claim.kept)) for claim in found]
        return tag("ul", head, rows, class_="claims", id=f"paper-{name}-claims")


# Table 1, Figures 3 and 4


def frequency_table(columns):
    """The paper's columns and ours."""
    def ours(name, line):
        return next((pair for pair in columns[name] if pair.line is line), None)

    def value(name, attribute):
        return lambda line: getattr(ours(name, line), attribute, math.nan)

    def whole(hz):
        return f"{hz:.0f}"

    shown = [Column("mode", lambda line: line.name, left=True),
             Column("Ansys", lambda line: float(line.ansys), whole),
             Column("Plast3", lambda line: float(line.plast3 or math.nan), whole)]
    for name in columns:
        shown += [Column(f"{name}, Hz", value(name, "ours"), whole),
                  Column("%", value(name, "error"), claims.percent)]
    return table("paper-table1-frequencies", shown, TABLE)


def table1(place):
    """Table 1."""
    columns = claims.table_columns(*map(place.path, ("modes-consistent", "modes-lumped", "response")))
    said = (f"Percent: of Ansys' column with consistent mass, of Plast3's with lumped mass and in time. All frequencies "
            f"of Plast3's column are multiples of {RESOLUTION} Hz, the resolution of the paper's transform: each is known "
            f"to {RESOLUTION / 2:.0f} Hz.")
    return (place.claims("table1", claims.table_claims(columns)), frequency_table(columns),
            tag("p", said, class_="quiet"))


def figure3(place):
    """Two meshes of the disc."""
    pairs = claims.mesh_pairs(place.folder("disc-10240", "fig3").path, place.folder("disc-2412", "fig3").path)
    freq, error = ([f * scale for f in values] for values, scale in zip(zip(*pairs), (1e-3, 100)))
    panel = Panel(Axis.about("difference of the coarse disc, %", error, True), 260)
    panel.rule(y=0, colour="ink")
    panel.points(freq, error, "blue", [f"{f:.3f} kHz: {e:+.2f} %" for f, e in zip(freq, error)])
    chart = Chart("difference of the frequencies of two meshes", Axis.about("frequency, kHz", freq), [panel])
    return place.claims("fig3", claims.mesh_claims(pairs)), figure("paper-fig3-chart", "Frequencies of two meshes",
                                                                  chart.markup("paper-fig3-svg"))


def shape_figure(name, title, shape, said=""):
    """A face with its title."""
    return figure(f"paper-{name}", title, shape.image(title), said)


def circles_figure(label, shape, freq):
    """What the nodes of the circles do at a peak."""
    panel = Panel(Axis("displacement / its largest", -1.1, 1.1), 260)
    panel.rule(y=0, colour="ink")
    keys = []
    for colour, (radius, angles, values) in zip(COLOURS, shape):
        panel.line(angles, values, colour, f"{radius:g} mm")
        keys.append((colour, "line", f"{radius:g} mm"))
    chart = Chart(f"{label} on circles of nodes", Axis("angle from the contact, degrees", -180, 180), [panel])
    name = f"paper-fig4-in-time-{label[3]}"
    return figure(name, f"{label} in time, {freq:.0f} Hz", [legend(keys), chart.markup(f"{name}-chart", "half")],
                  "Across the disc's face, on circles of nodes.")


def figure4(place):
    """Shapes of two modes, by the response in time and by the modes."""
    folder, response = place.folder("modes-lumped", "fig4"), place.path("response")
    rows = read_table(folder.path / "modes.csv", MODES)
    found, pictures = [], []
    for label in ("(0,4+)", "(0,5+)"):
        row = next((row for row in rows if row["label"] == label), None)
        if row:
            shape = mode_shape(folder.path, folder.disc(), row["mode"])
            pictures.append(shape_figure(f"fig4-{label[3]}", f"{label} by the modes, {row['freq_hz']:.0f} Hz", shape))
        found.append(claims.frequency_claim(label, "modes", row and row["freq_hz"]))
        if not response:
            continue
        freq, circles = peak_shape(response, label)
        found.append(claims.frequency_claim(label, "in time", freq))
        if freq:
            pictures.append(circles_figure(label, circles, freq))
    return place.claims("fig4", found), tag("div", pictures, class_="pair")


# Figures 5 and 6


def figure5(place):
    """Eigenvalues over the pad's modulus."""
    found, pictures = [], []
    for run, name in (("sweep", "the paper's values"), ("sweep-fitted", "fitted to the onsets")):
        folder = place.folder(run, f"paper-fig5-{run}")
        study = Study(folder.path, None, None)
        found += claims.sweep_claims(study, name, "fitted" in run)
        pictures.append([tag("h4", name.capitalize()), line_figure(folder, study)])
    return place.claims("fig5", found), pictures


def figure6(place):
    """Shapes of the unstable modes."""
    folder = place.folder("modes-unstable", "fig6")
    rows = [row for row in read_table(folder.path / "modes.csv", MODES) if row["unstable"]]
    found, pictures = [], []
    for family, band in claims.FAMILIES.items():
        own = [row for row in rows if band[0] <= row["freq_hz"] <= band[1]]
        if not own:
            found.append(claims.Claim(f"unstable mode near {family}", claims.SHAPES[family], "none", False))
            continue
        row = max(own, key=lambda row: row["growth_rad_s"])
        shape = mode_shape(folder.path, folder.disc(), row["mode"])
        found += claims.shape_claims(family, row, shape)
        pictures.append(shape_figure(f"fig6-{family[0]}", f"{row['label']}, {row['freq_hz']:.0f} Hz", shape,
                                     "Pad of 60 GPa."))
    return place.claims("fig6", found), tag("div", pictures, class_="pair")


# Figures 7 to 11


def force_part(name, run, claim):
    """Forces and acceleration."""
    def make(place):
        folder = place.folder(run, f"paper-{name}")
        record = Record(folder)
        pictures = [signal_figure(folder, record)]
        if record.vibration.line:
            pictures.append(growth_figure(folder, record))
        return (place.claims(name, claim(record)), force_figures(folder, record)[:1],
                tag("div", pictures, class_="pair"))

    return make


def spectrum_part(name, run, with_line, paper):
    """Spectrum and shape."""
    def make(place):
        folder = place.folder(run, f"paper-{name}")
        record = Record(folder)
        found, pictures = list(claims.line_claims(record)) if with_line else [], []
        if record.vibration.line:
            pictures.append(spectrum_figure(folder, record))
        first = record.run.time[record.vibration.steady][0]
        shape, share = moving_shape(folder.path, folder.disc(), first)
        circles = None
        if shape:
            found += claims.diameter_claims(shape, share, paper)
            pictures.append(shape_figure(f"{name}-shape", "Velocity across the disc's face", shape))
            circles = tag("div", diameters_figure(folder, snapshots(folder.path), first), class_="pair")
        return place.claims(name, found), tag("div", pictures, class_="pair"), circles

    return make


def pressing(place):
    """k_n."""
    return (place.claims("kn", claims.pressing_claims(place.folder("pressing", "kn").path)),)


SECTIONS = {"table1": table1, "fig3": figure3, "fig4": figure4, "fig5": figure5, "fig6": figure6,
            "fig7": force_part("fig7", "time-16", claims.stable_claims),
            "fig8": force_part("fig8", "time-25.1", claims.growth_claims),
            "fig9": spectrum_part("fig9", "time-25.1", True, "(0,4+)"),
            "fig10": force_part("fig10", "time-39.8", claims.detached_claims),
            "fig11": spectrum_part("fig11", "time-39.8", False, "that of Figure 9"), "kn": pressing}
ABOUT = {"table1": "frequencies of the disc's modes, pad of 25.1 GPa", "fig3": "two meshes of the disc",
         "fig4": "shapes of (0,4+) and (0,5+)", "fig5": "eigenvalues over the pad's modulus",
         "fig6": "shapes of the unstable modes", "fig7": "pad of 16 GPa in time", "fig8": "pad of 25.1 GPa in time",
         "fig9": "its spectrum and shape", "fig10": "pad of 39.8 GPa in time", "fig11": "its spectrum and shape",
         "kn": "pad of 16 GPa"}


# The page


def cost_table(place):
    """How long each run took."""
    rows = [(run, cost_of(place.folder(run.name, "cost"))) for run in place.runs if run.name in place.made]
    columns = [Column("run", lambda row: row[0].name, left=True),
               Column("for", lambda row: ", ".join(FIGURES[name] for name in row[0].figures), left=True),
               Column("time, s", lambda row: row[1][1] if row[1] else math.nan),
               Column("memory, MB", lambda row: float(row[1][2]) if row[1] else math.nan, lambda v: f"{v:.0f}")]
    total = sum(cost[1] for _, cost in rows if cost)
    return section("paper-cost", "What it took", table("paper-cost-table", columns, rows),
                   tag("p", f"One rank each; {total:.0f} s by the clock one after another.", class_="quiet"))


def opening(place, names, coarse):
    """The part of the page, and what is wrong with it."""
    parts, wrong = [], []
    for name in names:
        try:
            content = SECTIONS[name](place)
        except BadInput as error:
            wrong.append(f"{FIGURES[name]}: {error}")
            content = missing(f"{error}.")
        parts.append(section(f"paper-{name}", f"{FIGURES[name]}: {ABOUT[name]}", content))
    warning = missing("Small meshes and short records (--coarse): the numbers of this page mean nothing.")
    lead = tag("p", f"{sum(place.verdicts)} of {count(len(place.verdicts), 'statement')} of the paper with a yes or no "
               "come out here as in the paper.", class_="lead")
    said = [lead, [tag("p", text, class_="quiet") for text in (RULE, TUNED)]]
    content = [warning if coarse else said, parts, cost_table(place)]
    links = [(f"paper-{name}", FIGURES[name]) for name in names]
    return Opening("The paper beside ours", links, content), wrong


def write_paper(root, names, coarse):
    """The page of all runs that are complete; returns its name and a line for each thing that is wrong."""
    place = Place(root, chosen_runs(names))
    if not place.made:
        raise BadInput(f"{root}: no run is complete")
    first, wrong = opening(place, names, coarse)
    paths = [root / run.name for run in place.runs if run.name in place.made]
    page, others = write_page(paths, root / "paper.html", TITLE, Options(probe="edge"), first)
    return page, wrong + others
