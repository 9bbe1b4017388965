"""Errors of sweeps beside the errors that they state, over small random brakes. At each point of a sweep the matrices are
written by a full solution, and its eigenvalues refined in extended precision (exact.py) are the truth."""

import csv
import json
import math
import random
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

import numpy

from ..modes.exact import Pencil, exact_values
from ..run.program import scene

# Parameter: range around the scene's value, as a factor or as ends
SWEPT = {"contact_kn": (1e-4, 1e4, True), "contact_mu": (0.0, 1.2, False), "pad_young": (0.25, 4, True),
         "disc_young": (0.4, 2.5, True), "beam_young": (0.3, 3, True), "pad_density": (0.5, 2, True),
         "disc_density": (0.5, 2, True), "rows_stiffness": (0.1, 10, True), "disc_alpha": (0.0, 40, False)}
LINKED = {"disc_young": ("beam_young", 1e11, 1e12), "pad_density": ("disc_density", 2e3, 8e3)}  # and what takes its value
POINTS = 9
KINDS = ("parameter", "load", "two", "link", "load and parameter")


def even(low, high, generator):
    """A number between low and high, evenly in ratios, with six digits."""
    return float(f"{math.exp(generator.uniform(math.log(low), math.log(high))):.6g}")


def random_scene(seed):
    """Options of a small brake, and its parameters by name."""
    r = random.Random(seed)
    value = {"contact_kn": even(1e8, 1e10, r), "contact_mu": round(r.uniform(0.2, 0.7), 3),
             "pad_young": even(5e9, 4e10, r), "disc_young": even(1e11, 3e11, r), "beam_young": even(2e11, 2e12, r),
             "pad_density": even(2e3, 4e3, r), "disc_density": even(7e3, 8e3, r), "rows_stiffness": even(4e6, 1e8, r),
             "disc_alpha": 0.0}
    words = ["-rig_disc_elements", f"{r.choice((4, 5))},{r.choice((8, 10, 12))},1", "-rig_pad_elements",
             f"2,2,{r.choice((1, 2))}", "-rig_beam_elements", str(r.choice((3, 4, 5))),
             "-modes_band", f"{r.choice((0, 500))},{r.choice((9000, 11000, 13000))}"]
    if r.random() < 0.25:
        words += ["-pad_beta", f"{even(1e-8, 3e-7, r)}"]
        value["disc_alpha"] = round(r.uniform(1, 30), 2)
    if r.random() < 0.2:
        words += ["-contact_law", "constraint"]
    elif r.random() < 0.25:
        words += ["-modes_contact", "static", "-press_force", f"0,{even(5, 50, r):g},-100"]
    return words, value


def without(words, *names):
    """The words of a command line but for these options and their values."""
    pairs = zip(words[::2], words[1::2])
    return [word for name, value in pairs if name not in names for word in (name, value)]


def load_axis(words, value, r):
    """A load that presses down what another one lifts, so that pairs close as it grows: words, and the values of the load."""
    lift = even(20, 80, r)
    words = without(words, "-contact_law", "-modes_contact", "-press_force")
    words += ["-modes_contact", "static", "-loads", "press,side", "-side_set", "beam_top", "-side_force",
              f"0,{even(3, 0.6 * lift, r):g},{lift:g}"]
    value["press_force"] = 100.0
    value["contact_kn"] = even(1, 1e4, r) * value["contact_kn"]  # short vectors have large energies in a stiff contact
    return words, spaced(lift + even(0.5, 3, r), lift * even(1.3, 4, r), True, POINTS)


def spaced(low, high, ratio, n):
    """n values from low to high, evenly or evenly in ratios."""
    return [float(f"{low * (high / low)**(i / (n - 1)):.10g}" if ratio else f"{low + (high - low) * i / (n - 1):.10g}")
            for i in range(n)]


def random_sweep(seed):
    """Words of the scene, its values, the names and values of the axes, and what takes the value of the first."""
    words, value = random_scene(seed)
    r = random.Random(1000 + seed)
    kind = KINDS[seed % len(KINDS)]
    names = [name for name in SWEPT if name != "contact_kn" or "constraint" not in words]
    names = [name for name in names if name != "disc_alpha" or "-pad_beta" in words]
    chosen = [names[seed // len(KINDS) % len(names)]]
    axes, link = {}, None
    if kind.startswith("load"):
        words, axes["press_force"] = load_axis(words, value, r)
        chosen = chosen if kind == "load and parameter" else []
    elif kind == "two":
        chosen.append(r.choice([name for name in names if name not in chosen]))
    elif kind == "link":
        first = r.choice(list(LINKED))
        link, low, high = LINKED[first]
        axes[first], chosen = spaced(low, high, True, POINTS), []
    for name in chosen:
        low, high, ratio = SWEPT[name]
        low, high = (low * value[name], high * value[name]) if ratio else (low, high)
        axes[name] = spaced(low, high, ratio, POINTS)
    if len(axes) > 1:  # both ends and the middle
        axes = {name: values[::POINTS // 2] for name, values in axes.items()}
    return words, value, axes, link


def scene_words(words, value):
    """The whole command line of a scene, without output."""
    own = dict(value)
    own["rows_stiffness"] = f"0,{own['rows_stiffness']:.10g},0"
    if "press_force" in own:
        own["press_force"] = f"0,0,-{own['press_force']:.10g}"
    if "constraint" in words:
        del own["contact_kn"]
    return [*scene("massi2005"), *words, *(w for name, v in own.items() for w in (f"-{name}", v))]


def launch(program, words):
    """Runs squeal on one rank in this process' place; the reason of a failure, or None."""
    done = subprocess.run([str(word) for word in (program, *words)], capture_output=True, text=True, check=False)
    return (done.stderr.strip() or f"exit status {done.returncode}") if done.returncode else None


def eigenvalues(path, kept=lambda row: True):
    """(lambda, stated error rad/s, row) of a table."""
    with Path(path).open(newline="") as lines:
        return [(complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"])),
                 2 * math.pi * float(row["error_hz"] or "nan"), row) for row in csv.DictReader(lines) if kept(row)]


def full_point(program, folder, words, value, seen):
    """Modes of one point in full with their exact eigenvalues: [(exact, found, stated error)]; None where its matrices are among
    those that were seen."""
    reason = launch(program, [*scene_words(words, value), "-analysis", "modes", "-operators_save", folder / "ops",
                              "-output_dir", folder, "-output_fields", 0])
    if reason:
        raise RuntimeError(reason)
    contents = (value["contact_mu"], *(path.read_bytes() for path in sorted((folder / "ops").glob("[KMCH].bin"))))
    if hash(contents) in seen:
        return None
    seen.add(hash(contents))
    found = [(own, error) for own, error, _ in eigenvalues(folder / "modes.csv") if own != 0]
    pencil = Pencil(folder / "ops", value["contact_mu"])
    exact = exact_values(pencil, [own for own, _ in found], [error for _, error in found])
    return [(true, own, error) for true, (own, error) in zip(exact, found)]


def point_records(found, full):
    """(true error, stated error, relative) of the sweep's modes at a point, each with the nearest one in full."""
    records = []
    for own, stated, row in found:
        if own == 0 or not full:
            continue
        true, near, _ = min(full, key=lambda one: abs(one[1] - own))
        if math.isnan(float(abs(true))) or abs(near - own) > 1e-3 * abs(own):
            continue
        records.append((float(abs(true - own)) / abs(own), stated / abs(own), float(row["freq_hz"])))
    return records


def grid_points(axes):
    """Values of all points by name, the first parameter the fastest."""
    points = [{}]
    for name in reversed(axes):
        points = [{name: value, **point} for point in points for value in axes[name]]
    return points


def one_sweep(program, seed, every=1):
    """Errors of one sweep, at each `every`th point: (seed, name, [(true, stated, freq, point)] of the sweep, the same of its
    full solutions, reason). A point whose matrices are those of one before is left out, as where a load keeps the status."""
    words, value, axes, link = random_sweep(seed)
    with tempfile.TemporaryDirectory() as top:
        folder = Path(top)
        options = ["-sweep_parameter", ",".join(axes)]
        if link:
            options += ["-sweep_link", f"{next(iter(axes))},{link}"]
        for suffix, name in zip(("", "_2"), axes):
            options += [f"-sweep_values{suffix}", ",".join(f"{v:.10g}" for v in axes[name])]
        reason = launch(program, [*scene_words(words, value), "-analysis", "sweep", *options, "-sweep_onsets", 0,
                                  "-output_dir", folder / "sweep"])
        if reason:
            return seed, ",".join(axes), [], [], reason
        rows = eigenvalues(folder / "sweep/sweep.csv")
        sweep, modes, seen = [], [], set()
        for number, point in list(enumerate(grid_points(axes), 1))[::every]:
            place = folder / str(number)
            place.mkdir()
            if link:
                point = {**point, link: next(iter(point.values()))}
            try:
                full = full_point(program, place, words, {**value, **point}, seen)
            except RuntimeError as error:
                return seed, ",".join(axes), sweep, modes, str(error)
            if full is None:
                continue
            sweep += [(*record, number) for record in
                      point_records([one for one in rows if int(one[2]["point"]) == number], full)]
            modes += [(float(abs(true - own)) / abs(own), error / abs(own), own.imag / (2 * math.pi), number)
                      for true, own, error in full if not math.isnan(float(abs(true)))]
    return seed, ",".join(axes), sweep, modes, None


def effectivity(records):
    """True error over stated error of each record."""
    return numpy.array([record[0] / max(record[1], 1e-300) for record in records])


def read_results(path):
    """Results of one_sweep() by seed that an earlier run has kept; none where there is no file."""
    if not path or not path.exists():
        return {}
    with path.open() as lines:
        return {result[0]: result for result in map(json.loads, lines)}


def all_sweeps(program, seeds, workers, path=None):
    """one_sweep() of every seed as each ends. Those in the file of `path` are taken from there, others added to it."""
    kept = read_results(path)
    yield from (kept[seed] for seed in seeds if seed in kept)
    with ThreadPoolExecutor(workers) as pool:
        runs = [pool.submit(one_sweep, program, seed) for seed in seeds if seed not in kept]
        for run in as_completed(runs):
            if path:
                with path.open("a") as lines:
                    lines.write(json.dumps(run.result()) + "\n")
            yield run.result()
