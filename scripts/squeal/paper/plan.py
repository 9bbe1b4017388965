"""Which runs each table and figure of the seed paper needs."""

from typing import NamedTuple

from ..run.program import scene

FIGURES = {"table1": "Table 1", "fig3": "Figure 3", "fig4": "Figure 4", "fig5": "Figure 5", "fig6": "Figure 6",
           "fig7": "Figure 7", "fig8": "Figure 8", "fig9": "Figure 9", "fig10": "Figure 10", "fig11": "Figure 11",
           "kn": "Contact stiffness by pressing"}
LUMPED = "-contact_mu 0 -rig_disc_mesh axisymmetric -operators_mass lumped"
DISC = ("-model_source rig -rig_pad 0 -parts disc -disc_young 210e9 -disc_poisson 0.3 -disc_density 7800 -supports hub "
        "-hub_set disc_inner -hub_fix xyz -modes_band 0,20500 -modes_left 0 -output_fields 0")
IN_TIME = "-dynamics_snapshot_interval 0.5e-3 -dynamics_live 2"
# With --coarse: small bodies, few values, short records
SMALL = "-rig_disc_elements 8,24,1 -rig_pad_elements 4,4,2 -rig_beam_elements 10"
SMALL_SECONDS = 2.0
SMALL_IN_TIME = "-rig_disc_elements 8,32,1 -rig_pad_elements 4,4,2 -ts_max_time 8e-3"


class Planned(NamedTuple):
    """A run: its name, the figures that need it, options files of options/, options, those of --coarse, and how long it
    takes on one free core, s; `after`: a script of scripts/ that works on its folder when it has ended."""
    name: str
    figures: tuple
    files: tuple
    options: str
    coarse: str
    seconds: float
    after: str = ""

    def words(self, coarse):
        """Of the command line, without the folder."""
        return [*scene(*self.files), *self.options.split(), *(self.coarse.split() if coarse else [])]

    def lasts(self, coarse):
        """Seconds on one free core."""
        return min(self.seconds, SMALL_SECONDS) if coarse else self.seconds


def in_time(name, young, figures, length, seconds):
    """A case of the paper's section 5."""
    return Planned(name, figures, ("massi2005_transient",),
                   f"-pad_young {young} -ts_max_time {length} {IN_TIME}", SMALL_IN_TIME, seconds)


BRAKE, SWEEP = ("massi2005",), ("massi2005", "massi2005_sweep")
RUNS = (
    in_time("time-25.1", "25.1e9", ("fig8", "fig9"), "50e-3", 230),
    in_time("time-39.8", "39.8e9", ("fig10", "fig11"), "50e-3", 230),
    in_time("time-16", "16e9", ("fig7",), "25e-3", 115),
    Planned("response", ("table1", "fig4"), ("massi2005_transient", "massi2005_response"), "-dynamics_live 2",
            "-rig_disc_elements 8,40,1 -rig_pad_elements 4,4,2", 120, "response"),
    Planned("sweep", ("fig5",), SWEEP, "-modes_band 2500,6000", f"{SMALL} -sweep_values 6.5e9:80e9:12", 15),
    Planned("sweep-fitted", ("fig5",), (*SWEEP, "massi2005_fitted_sweep"), "-modes_band 2500,6000",
            f"{SMALL} -sweep_values 6.5e9:80e9:12", 10),
    Planned("modes-lumped", ("table1", "fig4"), BRAKE, f"{LUMPED} -modes_band 3000,20500 -modes_left 0",
            f"{SMALL} -modes_band 3000,9000", 18),
    Planned("modes-consistent", ("table1",), BRAKE, "-contact_mu 0 -modes_band 0,20500 -output_fields 0",
            f"{SMALL} -modes_band 0,9000", 8),
    Planned("disc-10240", ("fig3",), (), f"{DISC} -rig_disc_mesh axisymmetric",
            "-rig_disc_elements 10,48,2 -modes_band 0,9000", 7),
    Planned("disc-2412", ("fig3",), ("massi2005_coarse",), DISC,
            "-rig_disc_elements 8,24,1 -rig_pad_elements 4,4,2 -modes_band 0,9000", 3),
    Planned("modes-unstable", ("fig6",), BRAKE, "-pad_young 60e9 -modes_band 2500,6000", SMALL, 4),
    Planned("pressing", ("kn",), BRAKE, "-analysis static -contact_kn identify -pad_young 16e9", SMALL, 5),
)


def chosen_runs(figures):
    """Those that the figures need, the longest first."""
    runs = [run for run in RUNS if set(run.figures) & set(figures)]
    return sorted(runs, key=lambda run: -run.seconds)
