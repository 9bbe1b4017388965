"""Every scene of options/ on several numbers of ranks: what `scripts/study/gallery` runs, and its lines."""

import math
import subprocess
import time
from typing import NamedTuple

from ..mesh.gmsh import make_mesh
from ..run.launched import end
from ..run.program import ROOT, scene
from .table_difference import added_columns, difference, of_map, of_table, of_tables, read

SAME = 1e-9  # of the scale of a column
BUILDS = 1e-12  # the same between two builds on one rank
NUDGE = 2e-15  # relative change of a number of the scene, some roundings
SHARE = 0.1  # of the difference between ranks, which a nudge on one rank must make where rounding grows
ROWS = 1 / 3  # of the rows of a map that ranks change, which nudges must change
SPOKEN = "squeal: error", "collective: "  # how lines begin that say why a run ended


class Run(NamedTuple):
    """What is run of a scene: files of options/ in their order; the script of its mesh and, where it has one, its size, mm, and that of
    the quick run; words that the head of the file gives; words that make it shorter, and why; words of the quick run; an option
    to nudge."""
    files: str
    mesh: str = ""
    size: tuple = ()
    words: str = ""
    short: str = ""
    why: str = ""
    quick: str = ""
    nudge: tuple = ("pad_young", 25.1e9)
    grows: str = ""  # why rounding is more than SAME there: what ranks change, a nudge on one rank changes too


STEEL = 210e9
SMALL = "-rig_disc_elements 8,40,1 -rig_pad_elements 4,4,2 "
BLOCK = "block_young", 10e9
COARSE = {"fist_brake": {"vanes": 4, "order": 1}}  # numbers of the script of a mesh beside its size, of the quick run
IRON = "disc_young", 110e9
RUNS = {
    "affine": Run("affine", nudge=()),
    "affine sweep": Run("affine", words="-analysis sweep -sweep_parameter speed -sweep_values 1:5:41", nudge=()),
    "oscillator": Run("oscillator", nudge=()),
    "cantilever": Run("cantilever", "cantilever", nudge=("beam_young", STEEL)),
    "plate_absorber": Run("plate plate_absorber", nudge=("disc_young", STEEL), quick="-rig_disc_elements 8,48,1"),
    "plate": Run("plate", nudge=("disc_young", STEEL), quick="-rig_disc_elements 8,48,1"),
    "free_ring": Run("free_ring", nudge=("disc_young", STEEL), quick="-rig_disc_elements 8,48,1"),
    "block": Run("block", "block", nudge=BLOCK),
    "bar_impact": Run("bar_impact", "bars", nudge=("right_young", STEEL)),
    "sliding_block": Run("sliding_block", "sliding_block", nudge=("block_young", 1e9), short="-ts_max_time 50e-3",
                         why="at 51 ms friction stops it, and which node sticks first depends on rounding"),
    "massi2005": Run("massi2005", quick=SMALL),
    "massi2005 static": Run("massi2005", words="-analysis static", quick=SMALL),
    "massi2005_coarse": Run("massi2005 massi2005_coarse", quick="-rig_disc_elements 9,67,1 -rig_pad_elements 4,4,2"),
    "massi2005_frf": Run("massi2005 massi2005_frf", quick=SMALL + "-frf_frequencies 100:15000:150"),
    "massi2005_sweep": Run("massi2005 massi2005_sweep", quick=SMALL + "-sweep_values 6.5e9:80e9:15"),
    "massi2005_fitted_sweep": Run("massi2005 massi2005_sweep massi2005_fitted_sweep", quick=SMALL + "-sweep_values 6.5e9:80e9:15"),
    "massi2005_wear": Run("massi2005 massi2005_wear", quick=SMALL + "-sweep_values 0:60:4"),
    "massi2005_superelement": Run("massi2005 massi2005_superelement", quick=SMALL),
    "massi2005_reduced": Run("massi2005_reduced", short="-ts_max_time 5e-3", why="of 50 ms; growth from the blow",
                             quick=SMALL + "-ts_max_time 2e-3"),
    "massi2005_response": Run("massi2005_transient massi2005_response", short="-ts_max_time 1e-3", why="25 ms are half a million steps",
                              quick=SMALL + "-ts_max_time 1e-3", grows="rounding of 100 N at rest beside accelerations by 1e-7 N s"),
    "massi2005_transient": Run("massi2005_transient", short="-ts_max_time 1.5e-3", why="50 ms are a million steps",
                               quick=SMALL + "-ts_max_time 1.5e-3"),
    "brake": Run("brake", "brake", (14, 24), nudge=IRON),
    "brake_sweep": Run("brake brake_sweep", "brake", (24, 24), why="7 full solutions, hence 24 mm for 14", quick="-sweep_values 0.3,0.5",
                       nudge=IRON),
    "brake_transient": Run("brake brake_transient", "brake", (24, 24), short="-ts_max_time 5e-4", why="6 ms are 52,000 steps; 24 mm for 14",
                           quick="-ts_max_time 1e-4", nudge=IRON),
    "fist_brake": Run("fist_brake", "fist_brake", (24, 30), why="24 mm for 12", nudge=IRON),
    "fist_brake_transient": Run("fist_brake fist_brake_transient", "fist_brake", (24, 30), short="-ts_max_time 2e-3", why="24 mm for 12",
                                nudge=IRON),
    "small_brake_cycle": Run("small_brake_cycle"),
    "small_brake_shim": Run("small_brake_shim", "small_brake_shim", quick="-sweep_values 0.4e-3,0.8e-3", nudge=("strip_young", 110e9)),
    "small_brake_stop": Run("small_brake_stop", quick="-ts_max_time 0.05"),
    "small_brake_map": Run("small_brake_map", grows="impacts: transients with loss of contact are chaotic"),
}


class Gallery:
    """Meshes and runs below one folder."""

    def __init__(self, args):
        self.program, self.folder, self.seconds, self.quick = args.program, args.output.resolve(), args.seconds, args.quick
        self.before, self.scenes, self.changed = args.before, args.scenes, frozenset(args.changed)
        self.ranks = [int(word) for word in args.ranks.split(",")]
        self.preload = ["-x", f"LD_PRELOAD={args.collective.resolve()}"] if args.collective else []
        self.folder.mkdir(parents=True, exist_ok=True)

    def mesh(self, run):
        """Words for the mesh of a scene, which is made where it is not there."""
        if not run.mesh:
            return []
        numbers = {"size": run.size[self.quick]} if run.size else {"n": 2} if run.mesh == "sliding_block" else {}
        numbers |= COARSE.get(run.mesh, {}) if self.quick else {}
        path = self.folder / f"{run.mesh}{''.join(f'-{value}' for value in numbers.values())}.msh"
        if not path.exists():
            make_mesh("block" if run.mesh == "sliding_block" else run.mesh, path, **numbers)
        return ["-model_mesh", path]

    def words(self, run, before=None):
        """The command of a scene, without program and folder; with files of the folder `before` where it has them."""
        short = run.quick if self.quick and run.quick else run.short
        return [*scene(*run.files.split(), before=before), *self.mesh(run), *run.words.split(), *short.split(), "-output_fields", 0]

    def made(self, name, run, ranks, more=(), program=None):
        """The folder of a run and s of the clock; what happened in place of the folder where it did not end well."""
        out = self.folder / f"{name.replace(' ', '-')}-{ranks}{'-nudged' if more else '-before' if program else ''}"
        command = [ROOT / "scripts/mpirun", "-n", ranks, *(self.preload if ranks > 1 else []), program or self.program,
                   *self.words(run, self.scenes if program else None), *more, "-output_dir", out]
        begun = time.monotonic()
        with subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              text=True) as process:
            try:
                _, said = process.communicate(timeout=self.seconds)
            except subprocess.TimeoutExpired:
                end(process)
                return f"HANGS, no end in {self.seconds:g} s", self.seconds
        if process.returncode:
            out = f"EXIT {process.returncode}: {' | '.join(line for line in said.splitlines() if line.startswith(SPOKEN))}"
        return out, time.monotonic() - begun

    def perturbed(self, name, run, times=1):
        """Folder of a run on one rank with some roundings of one number of the scene; what happened where it did not end well."""
        option, value = run.nudge
        return self.made(f"{name} {times}" if times > 1 else name, run, 1, (f"-{option}", value * (1 + times * NUDGE)))[0]

    def excused(self, name, run, first, worst):
        """Whether that changes on one rank what ranks change, and how much it does in words. Nothing is where a run did not end, or has
        other words or numbers of rows: these are no rounding."""
        out = self.perturbed(name, run)
        nudged = math.nan if isinstance(out, str) else difference(first, out, SAME).value
        word = out if isinstance(out, str) else f"{nudged:.1e}"
        passed = bool(run.grows) and math.isfinite(worst) and math.isfinite(nudged) and nudged >= SHARE * worst
        return passed, f"{NUDGE:.0e} of {run.nudge[0]} on one rank: {word}"

    def excused_map(self, name, run, first):
        """The same of a map, whose regimes change after a loss of contact: rows before it and all modes agree; of the others as many
        nudges as there are numbers of ranks change at least a share of those that ranks change, and of those with other words."""
        folders = [self.folder / f"{name.replace(' ', '-')}-{ranks}" for ranks in self.ranks]
        one, maps = read(first / "map.csv"), [read(folder / "map.csv") for folder in folders]
        modes = [of_table("map_modes.csv", *(read(folder / "map_modes.csv") for folder in (first, other)), SAME) for other in folders]
        if any(len(other) != len(one) for other in maps):
            return False, "another number of rows"
        outs = [self.perturbed(name, run, times) for times in range(1, len(folders) + 1)]
        ended = [read(out / "map.csv") for out in outs if not isinstance(out, str)]
        found = [of_map(one, other, SAME) for other in maps]
        worst = max(value.value for value in [*modes, *(value for value, _ in found)])
        ranks = [max(counts) for counts in zip(*(counts for _, counts in found))]
        nudged = [max(counts) for counts in zip(*(of_map(one, other, SAME)[1] for other in ended))] or [-1, -1]
        passed = worst <= SAME and len(ended) == len(outs) and all(n >= ROWS * m for n, m in zip(nudged, ranks))
        return passed, (f"before a loss of contact {worst:.1e}; after it ranks change {ranks[0]} rows, {ranks[1]} in words; "
                        f"{NUDGE:.0e} of {run.nudge[0]} on one rank: {nudged[0]}, {nudged[1]}")

    def beside(self, name, run, first, ranks):
        """What a run on several ranks is beside that on one: its difference, and in words."""
        out, _ = self.made(name, run, ranks)
        if isinstance(out, str):
            return math.inf, f"{ranks}: {out}"
        found = difference(first, out, SAME)
        since = "" if math.isnan(found.since) else f", from {found.since:g} s"
        return found.value, f"{ranks}: {found.value:.1e}" + (f" ({found.where}{since})" if found.value > SAME else "")

    def compare_builds(self, name):
        """Prints the line of a scene that two builds computed on one rank; whether they agree."""
        (one, seconds), (other, _) = (self.made(name, RUNS[name], 1, program=program) for program in (None, self.before))
        if isinstance(one, str) or isinstance(other, str):
            print(f"{name:24} {one}; before: {other}", flush=True)
            return False
        added = added_columns(one, other)
        found = of_tables(one, other, BUILDS, added | self.changed)
        apart = [f"{table.value:.1e} {table.where}" for table in found if table.value > BUILDS]
        said = f"DIFFERS ({'; '.join(apart)})" if apart else "same"
        print(f"{name:24} {max(table.value for table in found):.1e} {said} ({seconds:.1f} s)"
              f"{'; added: ' * bool(added)}{' '.join(sorted(added))}", flush=True)
        return not apart

    def compare(self, name):
        """Prints the line of a scene; whether it is as asked for."""
        if self.before:
            return self.compare_builds(name)
        run = RUNS[name]
        first, seconds = self.made(name, run, 1)
        if isinstance(first, str):
            print(f"{name:24} 1: {first}", flush=True)
            return False
        found = [self.beside(name, run, first, ranks) for ranks in self.ranks]
        worst = max(value for value, _ in found)
        words, passed = [word for _, word in found], worst <= SAME
        ended = not any(mark in word for word in words for mark in (": HANGS", ": EXIT"))
        if not passed and run.nudge and ended:
            is_map = bool(run.grows) and (first / "map.csv").exists()
            passed, word = self.excused_map(name, run, first) if is_map else self.excused(name, run, first, worst)
            words.append(word)
        words.append("same" if worst <= SAME else f"rounding ({run.grows})" if passed else "DIFFERS")
        print(f"{name:24} {'; '.join(words)} ({seconds:.1f} s on one)", flush=True)
        return passed
