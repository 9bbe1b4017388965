#!/usr/bin/env python3
"""Where results come from. Breaks when scene.yaml does not repeat the run that wrote it, when tables of an earlier run
stay beside new ones, when a file of the user or of an unfinished run goes (whatever its name), or when a failed run removes anything.

    test_results.py SQUEAL MPIRUN"""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from served import RENAME, killed_at

SOURCE = Path(__file__).resolve().parents[1]
SCENE = """
model: {mesh: mesh/block.msh}
parts: base,block
base: {young: 210e9, poisson: 0.3, density: 7800}
block: {young: 10e9, poisson: 0.3, density: 2500}
supports: ground
ground: {set: base_bottom, fix: xyz}
springs: holder
holder: {set: block_top, stiffness: "1e6,1e6,0"}
loads: press
press: {set: block_top, force: "0,0,-1000"}
contacts: contact
contact: {surfaces: "block_bottom,base_top", law: constraint, mu: 0.3, slip: "0,1,0"}
modes: {target: 5000, count: 4}
"""
RUN = {"modes": ["-modes_contact", "static"], "static": ["-analysis", "static"],
       "transient": ["-analysis", "transient", "-ts_max_time", "2e-4", "-contact_speed", "1",
                     "-dynamics_history_interval", "1e-6"]}


class Runner:
    """Runs squeal in a folder of its own and keeps what is wrong."""

    def __init__(self, squeal, mpirun, folder):
        self.squeal, self.mpirun, self.folder, self.faults = squeal, mpirun, folder, []

    def run(self, *options, ranks=1, cwd=None):
        command = [self.mpirun, "-n", str(ranks), self.squeal, *options]
        return subprocess.run(command, capture_output=True, text=True, cwd=cwd or self.folder)

    def scene(self, analysis, *more, out="out", **how):
        return self.run("-options_file", self.folder / "scenes/mine.yaml", "-output_dir", self.folder / out, *RUN[analysis],
                        *more, **how)

    def files(self, out="out"):
        return sorted(path.name for path in (self.folder / out).iterdir())

    def check(self, holds, what, done=None):
        print("ok  " if holds else "FAIL", what)
        if not holds:
            self.faults.append(what)
            print(done.stdout + done.stderr if done else self.files())


def alike(first, second):
    """Whether two tables of modes hold the same frequencies; two ranks add up in any order."""
    rows = [[float(line.split(",")[1]) for line in path.read_text().splitlines()[1:]] for path in (first, second)]
    return len(rows[0]) == len(rows[1]) == 4 and all(abs(a - b) <= 1e-11 * b for a, b in zip(*rows))


def check_scene(r):
    """The repeated run gives the same table, from another folder and on two ranks."""
    elsewhere = r.folder / "elsewhere"
    elsewhere.mkdir()
    for ranks in (1, 2):
        done = r.scene("modes", "-contact_mu", "0.25", "-squeal_view", ranks=ranks)
        text = (r.folder / "out/scene.yaml").read_text()
        r.check(done.returncode == 0 and (r.folder / "out/modes.csv").exists(), f"modes on {ranks}", done)
        for word in ('contact_mu: "0.25"', 'squeal_view: "true"', 'modes_contact: "static"', "# versions: squeal ", "MUMPS",
                     f"# cost: {ranks} rank", "# stages: Model ", "# completeness: ",
                     "# contact_tolerance: 1e-05", "# command: ", "modes.csv"):
            r.check(word in text, f"scene.yaml on {ranks} says {word}", done)
        repeat = re.search(r"# repeat: (?:mpirun -n (\d+) )?squeal (.*)", text)
        options = repeat[2].replace(f"-output_dir {r.folder}/out", "-output_dir again").split()
        again = r.run(*options, ranks=int(repeat[1] or 1), cwd=elsewhere)
        r.check(again.returncode == 0 and alike(elsewhere / "again/modes.csv", r.folder / "out/modes.csv"),
                f"scene.yaml repeats the run on {ranks}, from another folder", again)
        r.check("option" not in again.stderr, "nothing in scene.yaml is unused", again)


def check_stale(r):
    """Each run leaves its own files, and those that are not squeal's."""
    for name in ("notes.txt", "mine.csv", "modes.csv.old"):
        (r.folder / "out" / name).write_text("mine")
    done = r.scene("modes", "-contact_mu", "nonsense")
    r.check(done.returncode != 0 and "modes.h5" in r.files(), "a run that fails removes nothing", done)
    done = r.scene("static")
    mine = ["mine.csv", "modes.csv.old", "notes.txt"]
    r.check(r.files() == sorted(["gap.csv", "reactions.csv", "scene.yaml", "static.csv", "static.h5", "static.xmf", *mine]),
            "after statics only its files and those of the user", done)
    done = r.scene("modes", "-output_fields", "0")
    r.check(r.files() == sorted(["modes.csv", "modes_causes.csv", "scene.yaml", *mine]), "after modes without fields only tables", done)
    done = r.scene("transient", "-dynamics_shape", r.folder / "out", ranks=2)
    r.check(done.returncode != 0, "a shape needs modes.h5", done)
    r.scene("modes")
    done = r.scene("transient", "-dynamics_shape", r.folder / "out", "-dynamics_snapshot_interval", "5e-5",
                   "-dynamics_checkpoint_interval", "20")
    r.check({"modes.h5", "modes.csv", "transient.csv", "snapshot_000001.h5", "checkpoint.bin"} <= set(r.files()),
            "the modes that a transient began with stay", done)
    done = r.scene("transient", "-dynamics_snapshot_interval", "1.5e-4")
    r.check("snapshot_000002.h5" not in r.files() and "modes.h5" not in r.files() and "snapshot_000001.h5" in r.files(),
            "snapshots beyond the new ones go", done)
    extra = {"circles.csv", "circle_nodes.csv", "impulses.csv"}
    done = r.scene("transient", "-circles", "rim", "-rim_part", "block", "-rim_radius", "0.05", "-rim_count", "4",
                   "-rim_tolerance", "0.02", "-impulses", "tap", "-tap_at", "0,0,0", "-tap_part", "block",
                   "-tap_impulse", "0,0,1e-3")
    r.check(extra <= set(r.files()), "circles and impulses have tables", done)
    done = r.scene("transient")
    r.check(done.returncode == 0 and not extra & set(r.files()), "which go with the next run that has none", done)


def check_users(r):
    """Files of the user under squeal's own names stay, as long as no run writes them."""
    names = ("parameters.csv", "static.csv", "snapshot_000000.h5", "sweep.csv")
    (r.folder / "users").mkdir()
    for name in names:
        (r.folder / "users" / name).write_text("precious")
    for analysis in ("modes", "transient", "modes"):
        done = r.scene(analysis, "-output_fields", "0", out="users")
        r.check(done.returncode == 0 and set(names) <= set(r.files("users"))
                and all((r.folder / "users" / name).read_text() == "precious" for name in names),
                f"{analysis} removes no file of the user", done)
    listed = (r.folder / "users/scene.yaml").read_text()
    r.check("transient.csv" not in r.files("users") and "static.csv" not in listed, "but those of the run before", done)


def check_unfinished(r):
    """What a stopped transient goes on from stays, and it does go on."""
    done = r.scene("transient", out="whole")
    r.scene("transient", "-dynamics_checkpoint_interval", "20", out="out")
    part = r.folder / "out/transient.csv"
    part.rename(part.with_suffix(".csv.part"))  # as a run that was killed leaves it
    done = r.scene("modes")
    r.check({"checkpoint.bin", "transient.csv.part", "modes.csv"} <= set(r.files()), "an unfinished run stays", done)
    kept = (r.folder / "out/checkpoint.bin").read_bytes()
    done = r.scene("transient", "-dynamics_checkpoint_interval", "20")
    r.check(done.returncode and "checkpoint.bin of an unfinished run would be lost" in done.stderr
            and (r.folder / "out/checkpoint.bin").read_bytes() == kept, "a fresh run does not take its checkpoint away", done)
    done = r.scene("transient", "-dynamics_restart", "-dynamics_checkpoint_interval", "20")
    same = part.exists() and part.read_bytes() == (r.folder / "whole/transient.csv").read_bytes()
    r.check(done.returncode == 0 and same, "and goes on bitwise", done)
    r.check({"checkpoint.bin", "transient.csv"} <= set(r.files()) and "modes.csv" not in r.files(), "its files stay", done)
    r.check("dynamics_restart:" not in (r.folder / "out/scene.yaml").read_text().split("# At")[0],
            "its scene is the whole run")


def check_killed(r):
    """A transient that is killed has listed its snapshots; they and its unfinished tables go when a later one has ended."""
    options = ("-dynamics_snapshot_interval", "4e-5", "-dynamics_pairs_interval", "4e-5")
    command = [r.mpirun, "-n", "1", r.squeal, "-options_file", r.folder / "scenes/mine.yaml", "-output_dir", r.folder / "killed",
               *RUN["transient"], *options]
    r.check(killed_at(command, r.folder / "killed/snapshot_000003.h5", r.folder, RENAME), "killed at its fourth snapshot")
    listed = (r.folder / "killed/scene.yaml").read_text()
    r.check(all(f"snapshot_00000{k}.h5" in listed for k in range(4)), "scene.yaml names the snapshots so far")
    (r.folder / "killed/snapshot_000007.h5").write_text("precious")
    done = r.scene("transient", "-output_fields", "0", out="killed")
    left = ["scene.yaml", "snapshot_000007.h5", "transient.csv"]
    r.check(done.returncode == 0 and r.files("killed") == left, f"go with the next run: {r.files('killed')}", done)


def check_names(r):
    """All tables of the sources are among those that a later run may remove; load.csv is beside saved matrices."""
    names = {name for path in (SOURCE / "src").rglob("*.c")
             for name in re.findall(r'ResultsTableOpen\([^"]*?"(\w+)"', path.read_text())} - {"load"}
    known = (SOURCE / "src/results/earlier.c").read_text()
    lost = [name for name in sorted(names) if f'"{name}.csv"' not in known]
    r.check(len(names) > 10 and not lost, f"tables that no later run removes: {lost}")


def check_foreign(r):
    """A user's file under the name of a checkpoint stays; one of a finished run goes with its tables."""
    (r.folder / "foreign").mkdir()
    file = r.folder / "foreign/checkpoint.bin"
    file.write_text("precious, longer than a head")
    done = r.scene("transient", out="foreign")
    r.check(done.returncode == 0 and file.exists() and file.read_text().startswith("precious"), "a user's checkpoint.bin stays", done)
    done = r.scene("transient", "-dynamics_checkpoint_interval", "20", out="foreign")
    r.check(done.returncode and "checkpoint.bin is no checkpoint of squeal" in done.stderr
            and file.read_text().startswith("precious"), "and is not replaced", done)
    r.scene("transient", "-dynamics_checkpoint_interval", "20", out="finished")
    done = r.scene("transient", out="finished")
    r.check(done.returncode == 0 and not (r.folder / "finished/checkpoint.bin").exists(), "that of a finished run goes", done)


def check_words(r):
    """Folders whose names hold blanks, quotes, and what looks like options, come through scene.yaml and its commands."""
    odd = r.folder / "it's -x \"y\" -modes_count 2 $HOME"
    (odd / "mesh").mkdir(parents=True)
    shutil.copy(r.folder / "scenes/mine.yaml", odd)
    shutil.copy(r.folder / "scenes/mesh/block.msh", odd / "mesh")
    done = r.run("-options_file", odd / "mine.yaml", "-output_dir", odd / "out", "-modes_count", "3")
    text = (odd / "out/scene.yaml").read_text() if done.returncode == 0 else ""
    given = re.findall(r"^(\w+): ", text, re.MULTILINE)
    r.check("model_mesh" in given and len(given) == len(set(given)) and not {"x", "x/mesh/block.msh"} & set(given),
            f"options of a scene in {odd.name}: {given}", done)
    first = (odd / "out/modes.csv").read_bytes() if done.returncode == 0 else b""
    for kind in ("repeat", "command"):
        (odd / "out/modes.csv").unlink(missing_ok=True)
        line = re.search(rf"# {kind}: (.*)", text)
        words = line[1].replace("squeal ", '"$0" ', 1) if line and kind == "repeat" else line[1] if line else "false"
        again = subprocess.run(["bash", "-c", words, r.squeal], capture_output=True, text=True, cwd=r.folder)
        r.check(again.returncode == 0 and (odd / "out/modes.csv").read_bytes() == first, f"bash runs the {kind} line {words}", again)


def check_damaged(r):
    """The message names the table that is damaged."""
    r.scene("transient", "-dynamics_checkpoint_interval", "20", out="damaged", ranks=2)
    table = r.folder / "damaged/transient.csv"
    for path in (table, table.with_suffix(".csv.part")):
        if path != table:
            table.rename(path)
        path.write_bytes(path.read_bytes()[:40])
        done = r.scene("transient", "-dynamics_restart", "-dynamics_checkpoint_interval", "20", out="damaged", ranks=2)
        r.check(done.returncode and f"cannot go on with {path}: " in done.stderr, f"{path.name} is named", done)


def check_path(r):
    """A path in an options file begins there, one on the command line in the working folder."""
    elsewhere = r.folder / "elsewhere"
    done = r.scene("static", "-model_mesh", "scenes/mesh/block.msh")
    r.check(done.returncode == 0, "a path on the command line", done)
    done = r.scene("static", "-model_mesh", "mesh/block.msh")
    r.check(done.returncode != 0 and "mesh/block.msh" in done.stderr, "is not one beside the options file", done)
    (r.folder / "scenes/over.yaml").write_text("contact: {mu: 0.1}\n")
    done = r.scene("static", "-options_file", r.folder / "scenes/over.yaml", cwd=elsewhere)
    r.check(done.returncode == 0, "a path in the first of two options files", done)


def main():
    squeal, mpirun = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory(prefix="squeal-") as folder:
        r = Runner(squeal, mpirun, Path(folder).resolve())
        (r.folder / "scenes/mesh").mkdir(parents=True)
        (r.folder / "scenes/mine.yaml").write_text(SCENE)
        subprocess.run([sys.executable, SOURCE / "tests/mesh.py", "blocks", "--elements", "3,3,3",
                        r.folder / "scenes/mesh/block.msh"], check=True)
        for check in (check_scene, check_stale, check_users, check_unfinished, check_killed, check_names, check_foreign, check_damaged,
                      check_words, check_path):
            check(r)
    if r.faults:
        print(f"{len(r.faults)} failed: {'; '.join(r.faults)}")
    return 1 if r.faults else 0


if __name__ == "__main__":
    sys.exit(main())
