#!/usr/bin/env python3
"""Runs scripts/study/job.slurm with a stand-in for the program that writes made-up tables, and checks what
scripts/study/collect_sweeps makes of them: without Slurm, as a task of a job array, after a killed run, and with
stand-ins for Slurm's commands. The values come from the tables that were written. Exit status: 0, or 1.
"""

import csv
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from drawing import SCRIPTS, fails, require
from made_up_sweep import PAIRS, onsets

TESTS = Path(__file__).resolve().parent
VALUES = ["0.6", "0.3", "0.5", "0.45"]

# Writes the tables for -contact_mu to -output_dir; is killed at `fatal` the first time
PROGRAM = """#!{python}
import os, signal, sys
from pathlib import Path
sys.path.insert(0, "{tests}")
from made_up_sweep import write_sweep
option = dict(zip(sys.argv[1:], sys.argv[2:]))
folder = Path(option["-output_dir"])
assert option["-analysis"] == "sweep" and option["-options_file"] == "scene.yaml" and option["-modes_band"] == "0,20000"
killed = folder / "killed"
if option["-contact_mu"] == os.environ.get("FATAL") and not killed.exists():
    killed.touch()
    os.kill(os.getpid(), signal.SIGKILL)
write_sweep(folder, float(option["-contact_mu"]), values=[20e9, 30e9, 60e9])
"""


class Study:
    """A folder in which job.slurm works, with stand-ins for programs."""

    def __init__(self, root):
        self.root, self.folder = root, root / "study"
        self.stand_in("squeal", PROGRAM.format(python=sys.executable, tests=TESTS))
        self.environment = {key: value for key, value in os.environ.items() if not key.startswith(("SLURM", "SQUEAL"))}
        self.environment.update(SQUEAL_PROGRAM=str(root / "squeal"), SQUEAL_LAUNCHER="env", SQUEAL_SCENE="scene.yaml",
                                SQUEAL_VALUES=" ".join(VALUES), SQUEAL_STUDY=str(self.folder),
                                PATH=f"{root}:{os.environ['PATH']}")

    def stand_in(self, name, text):
        (self.root / name).write_text(text)
        (self.root / name).chmod(0o755)

    def job(self, *arguments, **environment):
        """Runs job.slurm."""
        return subprocess.run(["bash", SCRIPTS / "study/job.slurm", *arguments], env=self.environment | environment,
                              cwd=SCRIPTS.parent, capture_output=True, text=True, check=False)

    def table(self, name):
        with (self.folder / name).open(newline="") as lines:
            return list(csv.DictReader(lines))


def check_tables(study):
    """All rows of all runs, in the order of mu, as they were written: breaks when a run or a column is lost."""
    rows, found = study.table("study.csv"), study.table("study_onsets.csv")
    require(list(rows[0])[:3] == ["run", "contact_mu", "point"], f"columns {list(rows[0])[:3]}")
    ordered = sorted(map(float, VALUES))
    require(list(dict.fromkeys(float(row["contact_mu"]) for row in rows)) == ordered, "other values of contact_mu")
    for value in VALUES:
        with (study.folder / f"contact_mu_{value}" / "sweep.csv").open(newline="") as lines:
            written = list(csv.DictReader(lines))
        key = {"run": f"contact_mu_{value}", "contact_mu": value}
        own = [row for row in rows if row["run"] == key["run"]]
        require(own == [key | row for row in written], f"other rows than those of contact_mu {value}")
        expected = sum(len(onsets(float(value), pair)) for pair in PAIRS)
        count = sum(row["run"] == f"contact_mu_{value}" for row in found)
        require(expected and count == expected, f"{count} onsets at contact_mu {value} instead of {expected}")


def test_loop(root):
    """Without Slurm: a killed run is named, the others are made and collected; the same command completes the study."""
    study = Study(root)
    first = study.job("-modes_band", "0,20000", FATAL="0.5")
    require(first.returncode == 1 and "contact_mu 0.5: exit status 137" in first.stderr, f"killed run: {first.stderr}")
    require("without contact_mu_0.5" in first.stderr, f"collected a killed run: {first.stderr}")
    require(len({row["run"] for row in study.table("study.csv")}) == 3, "not the three other runs")
    second = study.job("-modes_band", "0,20000", FATAL="0.5")
    require(second.returncode == 0, f"again: {second.stderr}")
    check_tables(study)


def test_task(root):
    """A task of an array makes its own value only; one beyond the values is an error."""
    study = Study(root)
    result = study.job("-modes_band", "0,20000", SLURM_JOB_ID="7", SLURM_ARRAY_TASK_ID="2")
    made = [path.name for path in study.folder.iterdir()]
    require(result.returncode == 0 and made == [f"contact_mu_{VALUES[2]}"], f"task 2 made {made}: {result.stderr}")
    require(study.job(SLURM_JOB_ID="7", SLURM_ARRAY_TASK_ID="4").returncode == 2, "a task without a value")


def test_time_limit(root):
    """Slurm's signal before the time limit puts the task back into the queue, and the run is not disturbed by it."""
    study = Study(root)
    study.stand_in("scontrol", f"#!/bin/sh\necho \"$@\" > {root}/scontrol.log\n")
    study.stand_in("squeal", "#!/bin/sh\nkill -USR1 $PPID\nsleep 1\ntouch \"$STARTED\"\n")
    job = {"SLURM_JOB_ID": "8", "SLURM_ARRAY_JOB_ID": "7", "SLURM_ARRAY_TASK_ID": "1", "STARTED": str(root / "ended")}
    result = study.job(**job)
    require((root / "ended").exists() and result.returncode == 0, f"the run was disturbed: {result.stderr}")
    require((root / "scontrol.log").read_text() == "requeue 7_1\n", "another task was requeued")
    (root / "scontrol.log").unlink()
    study.job(**job, SLURM_RESTART_COUNT="10")
    require(not (root / "scontrol.log").exists(), "requeued for ever")


def test_submit(root):
    """One task a value, and the collection after them."""
    study = Study(root)
    study.stand_in("sbatch", f"#!/bin/sh\necho \"$@\" >> {root}/sbatch.log\necho '41;cluster'\n")
    require(study.job("submit", "-modes_band", "0,20000").returncode == 0, "submit")
    array, after = (root / "sbatch.log").read_text().splitlines()
    require("--array=0-3" in array and array.endswith("job.slurm -modes_band 0,20000"), array)
    require("--dependency=afterany:41 " in after and after.endswith("job.slurm collect"), after)


def test_errors(root):
    """What cannot be collected ends in one line that names it."""
    study = Study(root)
    require(study.job("-modes_band", "0,20000").returncode == 0, "the study")
    sweep = study.folder / "contact_mu_0.3" / "sweep.csv"
    text = sweep.read_text()
    cases = [(study.folder, text[:-20], [], f"{sweep}: line "),
             (study.folder, text.replace("class", "kind", 1), [], "other columns"),
             (study.folder, text, ["--parameter", "kn"], "--parameter kn: no such parameter"),
             (study.folder / "nothing", text, [], "nothing: no such folder"),
             (study.folder / "contact_mu_0.3", text, [], "none of its 0 folders")]
    for folder, content, options, expected in cases:
        sweep.write_text(content)
        fails("study/collect_sweeps", folder, options, expected)


def main():
    for test in (test_loop, test_task, test_time_limit, test_submit, test_errors):
        with tempfile.TemporaryDirectory() as folder:
            test(Path(folder))
            print(f"{test.__name__}: passed")


if __name__ == "__main__":
    main()
