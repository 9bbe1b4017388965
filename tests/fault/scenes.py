"""Tiny scenes in which calls fail: what they run, and which files of an earlier run may be gone while they do."""

import importlib.util
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
BRAKE = ("-options_file", "brake.yaml", "-model_mesh", "blocks.msh")
FINER = ("-options_file", "brake.yaml", "-model_mesh", "finer.msh", "-modes_band", "0,2500")
TIME = ("-analysis", "transient", "-press_ramp", "1e-4", "-dynamics_live", "0", "-dynamics_checkpoint_interval", "20",
        "-dynamics_pairs_interval", "1e-5", "-probes", "tip", "-tip_at", "0,0,0.1", "-tip_part", "block")


class Scene:
    """A command; goes_on: the option with which a later run takes up what a killed one kept, None where it begins anew, whose files
    change while it runs: the checkpoint, which an earlier run loses, and the list of snapshots. loses: files of an earlier run that
    may go before this one writes its own."""

    def __init__(self, name, words, goes_on=None, loses=()):
        self.name, self.words, self.goes_on = name, (*words, "-output_dir", "out"), goes_on
        self.loses = {*loses, *(("checkpoint.bin",) if goes_on else ())}


SCENES = (
    Scene("modes", BRAKE),
    Scene("matrices", (*BRAKE, "-operators_save", "out", "-output_fields", "0"), loses=("F.bin",)),  # loads of other matrices
    Scene("sweep", (*FINER, "-analysis", "sweep", "-sweep_rtol", "1e-9")),
    Scene("static", (*BRAKE, "-analysis", "static")),
    Scene("frf", (*BRAKE, "-analysis", "frf", "-probes", "tip", "-tip_at", "0,0,0.1", "-tip_part", "block", "-frf_force",
                  "tip,z", "-frf_frequencies", "100:2000:5", "-frf_times", "0:0.01:5")),
    Scene("transient", (*BRAKE, *TIME, "-ts_max_steps", "60", "-dynamics_snapshot_interval", "4e-4"), "-dynamics_restart"),
    Scene("reduced", (*BRAKE, *TIME, "-ts_max_steps", "60", "-dynamics_model", "reduced", "-dynamics_cutoff", "3000",
                      "-dynamics_snapshot_interval", "1e-3"), "-dynamics_restart"),
    Scene("map", (*BRAKE, "-analysis", "map", "-impulses", "tap", "-tap_at", "0,0,0.1", "-tap_part", "block", "-tap_impulse",
                  "0,0,1e-4", "-map_parameter", "contact_mu", "-map_values", "0.2,0.4", "-map_window", "2e-3", "-ts_max_time",
                  "16e-3", "-dynamics_model", "reduced", "-dynamics_cutoff", "3000")),
)


def fuzz_scenes():
    """tests/fuzz/scenes.py, whose name is that of this file."""
    folder = TESTS / "fuzz"
    sys.path.append(str(folder))
    spec = importlib.util.spec_from_file_location("fuzz_scenes", folder / "scenes.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def make(folder):
    """The files that the scenes read."""
    (folder / "brake.yaml").write_text(fuzz_scenes().BRAKE)
    for name, elements in (("blocks.msh", "1,1,1"), ("finer.msh", "2,2,2")):
        subprocess.run([sys.executable, TESTS / "mesh.py", "blocks", "--elements", elements, folder / name], check=True,
                       capture_output=True)
