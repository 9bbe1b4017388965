"""Result folders of a small brake, one for each analysis, for tests of what reads them."""

import subprocess
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
BRAKE = ["-options_file", SOURCE / "options/massi2005.yaml", "-rig_disc_elements", "8,24,1", "-rig_pad_elements",
         "4,4,2",
         "-rig_beam_elements", "10"]
IN_TIME = ["-options_file", SOURCE / "options/massi2005_transient.yaml", "-rig_disc_elements", "8,32,1",
           "-rig_pad_elements", "4,4,2"]
RUNS = {
    "modes": [*BRAKE, "-contact_mu", "0.9", "-pad_young", "39.8e9", "-modes_components", "1.2", "-modes_sensitivities"],
    "modes_quiet": [*BRAKE, "-contact_mu", "0", "-modes_band", "0,6000"],
    "static": [*BRAKE, "-analysis", "static", "-static_view_kkt"],
    "sweep": [*BRAKE, "-analysis", "sweep", "-modes_band", "1000,6000", "-sweep_parameter", "pad_young",
              "-sweep_values", "6.5e9:14e9:10", "-sweep_verify", "2"],
    "map": [*BRAKE, "-rows_stiffness", "0,18.5e6,0", "-analysis", "sweep", "-modes_band", "2500,5600",
            "-sweep_parameter", "pad_young,contact_mu", "-sweep_values", "6.5e9:14e9:4",
            "-sweep_values_2", "0,0.4,0.8"],
    "frf": [*BRAKE, "-options_file", SOURCE / "options/massi2005_frf.yaml", "-frf_frequencies", "1500:4500:151"],
    "filters": [*IN_TIME, "-analysis", "modes", "-modes_contact", "static", "-operators_mass", "lumped",
                "-contact_friction_damping", "-modes_band", "3000,6000", "-modes_filters", "-output_fields", "0"],
    "transient": [*IN_TIME, "-dynamics_filters", "filters", "-dynamics_filters_modes", "1,2,3",
                  "-ts_max_time", "8e-3", "-dynamics_snapshot_interval", "0.5e-3"],
    "vibration": ["-options_file", SOURCE / "options/small_brake_map.yaml", "-map_values", "0.3,0.6", "-map_values_2", "100,200",
                  "-ts_max_time", "32e-3"],
    "cycle": ["-options_file", SOURCE / "options/small_brake_cycle.yaml", "-cycle_range", "0.41,0.43", "-cycle_verify", "false",
              "-dynamics_cutoff", "9e3"],
}


def make_results(squeal, mpirun, folder, names=tuple(RUNS)):
    """Runs squeal for each name into a folder of that name."""
    for name in names:
        command = [mpirun, "-n", "1", squeal, *RUNS[name], "-squeal_view", "-output_dir", folder / name]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, cwd=folder, check=False)
        if done.returncode:
            raise SystemExit(f"{name}: {done.stderr}")
        (folder / name / "log.txt").write_text(done.stdout)
