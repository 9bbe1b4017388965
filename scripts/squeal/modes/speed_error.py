"""What the studies of speed against error share: runs that are timed in units of one that is repeated between them, a table, a
picture with the cost on one axis and the error on the other, and three sentences that say what to take for which accuracy.

A study is a short file: its runs, its reference and its error make Points; main() does the rest. Times are of the processor, medians
over rounds, of the whole process; a study of ranks takes those of the clock."""

import argparse
import csv
import math
import statistics
import time
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from ..picture import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, VERMILION, boxes_about, place_texts, plain_ticks, save_picture
from ..run.program import chosen_program, machine_text, measured_run, scene
from ..tables import BadInput, print_table, read_table, run, whole

LEAST = 1e-16  # errors of nothing are drawn here
LEAST_RANGE = 4  # of costs in a picture, last to first
ALIKE = 1.05  # costs that differ by less are the same
COLORS = BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, GREY, INK
MARKERS = "osD^v<>P"
UNIT = (*scene("massi2005"), "-rig_disc_elements", "12,56,1", "-rig_pad_elements", "5,5,5", "-rig_beam_elements", 10,
        "-modes_band", "1000,9000", "-output_fields", 0, "-squeal_progress", 0)
UNIT_TEXT = "all modes of a coarse brake of 5,760 unknowns from 1 to 9 kHz"


class Point(NamedTuple):
    """One setting of one method: its error, relative, and its cost in s and in units."""
    series: str
    setting: str
    error: float
    seconds: float
    units: float


class Bench:
    """Runs of one study: program, folder, rounds, whether all is smaller, and the unit of time."""

    def __init__(self, args):
        self.program, self.folder, self.quick = args.program, args.output, args.quick
        self.rounds = 1 if args.quick else args.rounds
        self.folder.mkdir(parents=True, exist_ok=True)
        self.unit_times = []
        self.points = []

    def once(self, words, name, ranks=1, clock=False):
        """Folder, text and s of processor (or of the clock) of a run."""
        folder = self.folder / name
        folder.mkdir(parents=True, exist_ok=True)
        begun = time.perf_counter()
        text, seconds, _ = measured_run(self.program, ranks, [*words, "-output_dir", folder], name)
        return folder, text, time.perf_counter() - begun if clock else seconds

    def timed(self, words, name, ranks=1, clock=False):
        """The same with the median of the rounds, each after a run of the unit."""
        times = []
        for _ in range(self.rounds):
            self.unit_times.append(self.once(UNIT, "unit", clock=clock)[2])
            folder, text, seconds = self.once(words, name, ranks, clock)
            times.append(seconds)
        return folder, text, statistics.median(times)

    @property
    def unit(self):
        """s of the unit, the median of its runs so far."""
        return statistics.median(self.unit_times)

    def add(self, series, setting, error, seconds):
        """A point, printed as it comes; its units are known at the end."""
        print(f"  {series}, {setting}: error {error:.2g}, {seconds:.3g} s", flush=True)
        self.points.append(Point(series, setting, float(error), seconds, math.nan))

    def finished(self):
        """The points with their units."""
        return [point._replace(units=point.seconds / self.unit) for point in self.points]


def write_points(path, points):
    """All of them."""
    with whole(path) as part, part.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["series", "setting", "error", "seconds", "units"])
        table.writerows([p.series, p.setting, f"{p.error:.6e}", f"{p.seconds:.4f}", f"{p.units:.4f}"] for p in points)


def read_points(path):
    """Those of a table."""
    kinds = {"series": str, "setting": str, "error": float, "seconds": float, "units": float}
    return [Point(*row.values()) for row in read_table(path, kinds)]


def draw(path, title, error_name, points, knob=""):
    """Error over cost, both logarithmic; each point has its setting beside it, where there is room."""
    figure, axes = plt.subplots(figsize=(9, 5.2), layout="constrained")
    texts = []
    for i, series in enumerate(dict.fromkeys(point.series for point in points)):
        own = [point for point in points if point.series == series]
        x, y = [point.units for point in own], [max(point.error, LEAST) for point in own]
        axes.loglog(x, y, "-" if i < len(COLORS) else "--", marker=MARKERS[i % len(MARKERS)], color=COLORS[i % len(COLORS)],
                    markersize=5, linewidth=1.1, label=series)
        texts += [((a, b), point.setting) for a, b, point in zip(x, y, own)]
    axes.grid(True, which="major", linewidth=0.3)
    axes.margins(0.08)
    low, high = axes.get_xlim()
    if high < LEAST_RANGE * low:  # so that what costs the same looks so
        axes.set_xlim(math.sqrt(low * high / LEAST_RANGE), math.sqrt(low * high * LEAST_RANGE))
    plain_ticks(axes.xaxis, "23456789")
    axes.set_xlabel(f"time, in units of {UNIT_TEXT}")
    axes.set_ylabel(error_name)
    axes.set_title(title, fontsize=11)
    axes.legend(fontsize=8, title=f"at the points: {knob.strip()}" if knob else None, title_fontsize=8)
    figure.canvas.draw()
    taken = [axes.get_legend().get_window_extent(), *boxes_about(axes, [place for place, _ in texts], 4)]
    place_texts(axes, texts, [(0, 9), (0, -10), (24, 0), (-24, 0), (0, 18), (0, -19)], taken, fontsize=7)
    save_picture(figure, path, dpi=110)
    plt.close(figure)


def settings(points, among, knob):
    """Points in words, by method in order of their cost: three settings or more that stand side by side as first to last."""
    said = []
    for series in dict.fromkeys(point.series for point in points):
        order = [point.setting for point in among if point.series == series]
        own, spans = {point.setting for point in points if point.series == series}, []
        for before, setting in zip((None, *order), order):
            if setting in own and before in own:
                spans[-1].append(setting)
            elif setting in own:
                spans.append([setting])
        texts = [f"{span[0]} to {span[-1]}" if len(span) > 2 else " or ".join(span) for span in spans]
        said.append(f"{series} with {knob}{' or '.join(texts)}")
    return ", ".join(said)


def others(good, alike, knob):
    """What the cheapest setting of every other method needs, the first of them named."""
    first = {}
    for point in good:
        first.setdefault(point.series, point)
    dearer = [point for series, point in first.items() if series not in {same.series for same in alike}]
    if not dearer:
        return "" if len({point.series for point in alike}) > 1 else "; no other method is so exact"
    named = f"; {dearer[0].series} needs {dearer[0].units:.3g} with {knob}{dearer[0].setting}"
    return named + "".join(f", {point.series} {point.units:.3g}" for point in dearer[1:])


def sentence(points, level, knob=""):
    """What to take for an error: of the settings that cost the least, alike within ALIKE, the most exact, within a factor of 2 the
    first of the study; the others of these; and what other methods need. level: a number; with the methods among which to choose
    where not all do the same; or with one series where these are not methods but things that have errors. knob: the option that the
    settings are values of."""
    level, of = level if isinstance(level, tuple) else (level, None)
    among, of = (of, None) if isinstance(of, tuple) else (of and (of,), of)
    points = [point for point in points if not among or point.series in among]
    good = sorted((point for point in points if point.error <= level), key=lambda point: point.units)
    if not good:
        best = min(points, key=lambda point: point.error)
        return (f"An error of {level:g} is reached by none of these; the least is {best.error:.1g}, of {best.series} with "
                f"{knob}{best.setting}.")
    alike = [point for point in good if point.units <= ALIKE * good[0].units]
    best = next(point for point in points if point in alike and point.error <= 2 * min(same.error for same in alike))
    named = f"For an error of {level:g} {f'of {of} take' if of else f'take {best.series} with'} {knob}{best.setting}"
    text = f"{named}: {best.units:.3g} units (error {best.error:.1g})"
    within = f"within {100 * (ALIKE - 1):.0f} %"
    if of and len(good) > 1 and good[-1].units <= ALIKE * best.units:
        return f"{text}; all {len(good)} settings that reach it cost the same {within}."
    if len(alike) > 1:
        same = settings([point for point in alike if point is not best], points, knob)
        text += f"; as cheap {within}: {same.removeprefix(f'{of} with ') if of else same}"
    if not of:
        return f"{text}{others(good, alike, knob)}."
    if len(good) == 1:
        return f"{text}; no other setting is so exact."
    return f"{text}; {knob}{good[-1].setting}, the dearest of those that reach it, needs {good[-1].units:.3g}."


def arguments(doc, name):
    """The command line of a study."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="fewer settings, one round")
    parser.add_argument("--rounds", type=int, default=3, metavar="N", help="of which times are medians, default: 3")
    parser.add_argument("--output", type=Path, default=Path("results/studies") / name, metavar="DIR",
                        help=f"where study.csv, study.png, study.txt and runs go, default: results/studies/{name}")
    parser.add_argument("--program", type=Path, metavar="FILE", help="squeal; default: compiled as by scripts/run")
    parser.add_argument("--redraw", action="store_true", help="no runs: picture and sentences anew from the study.csv of --output")
    args = parser.parse_args()
    if args.rounds < 1:
        parser.error(f"--rounds {args.rounds}: must be 1 or more")
    args.program = None if args.redraw else chosen_program(args.program)
    return args


class Study(NamedTuple):
    """What a study says of its points, as main() has it."""
    title: str
    levels: tuple
    error_name: str
    knob: str

    def tell(self, folder, points, about):
        """Picture and sentences; these."""
        draw(folder / "study.png", self.title, self.error_name, points, self.knob)
        lines = [sentence(points, level, self.knob) for level in self.levels]
        with whole(folder / "study.txt") as part:
            part.write_text("\n".join([self.title, about, *lines]) + "\n", encoding="utf-8")
        print("\n" + "\n".join(["", about, *lines]))

    def again(self, folder):
        """The same of a study that ran before; its table."""
        said = folder / "study.txt"
        points = read_points(folder / "study.csv")
        about = said.read_text(encoding="utf-8").splitlines()[1:2]
        if not points or not about:
            raise BadInput(f"{said if points else folder / 'study.csv'}: holds nothing; without --redraw the study runs")
        self.tell(folder, points, about[0])
        return folder / "study.csv"

    def made(self, args, name, work):
        """The runs, and what is said of them; the table."""
        bench, begun = Bench(args), time.perf_counter()
        print(machine_text())
        reference = work(bench)
        points = bench.finished()
        if not points or not all(math.isfinite(point.error) for point in points):
            raise BadInput(f"{name}: a point has no error")
        write_points(bench.folder / "study.csv", points)
        print_table(self.title, ("method", "setting", "error", "s", "units"), *(
            (p.series, p.setting, f"{p.error:.2e}", f"{p.seconds:.3f}", f"{p.units:.3f}") for p in points))
        self.tell(bench.folder, points, f"{reference} The unit is {UNIT_TEXT}, here {bench.unit:.2f} s; times are medians of "
                  f"{bench.rounds}. {machine_text().capitalize()}; the study took {time.perf_counter() - begun:.0f} s.")
        return bench.folder / "study.csv"


def main(doc, name, work, levels, error_name, knob=""):
    """Runs a study: work(bench) adds its points and returns what its reference is, in a sentence; knob: as sentence() has it. Exit
    status."""
    args = arguments(doc, name)
    study = Study(doc.splitlines()[0].rstrip("."), levels, error_name, knob)
    return run(f"study/{name}", lambda: study.again(args.output) if args.redraw else study.made(args, name, work))
