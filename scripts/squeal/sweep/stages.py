"""Where the time of a sweep goes: basis, points, onsets; damped brakes, of which every onset is a growth of zero."""

from ..run.program import met
from .runs import SweepRun
from ..tables import print_table

VALUES = "-analysis sweep -sweep_parameter contact_mu -sweep_values 0.05:1.2:29"
SMALL = "-rig_disc_elements 8,24,1 -rig_pad_elements 4,4,2 -rig_beam_elements 10 -modes_band 100,12000"
MEDIUM = "-rig_disc_elements 15,72,2 -rig_pad_elements 8,8,8 -rig_beam_elements 20 -modes_band 100,12000"
SCENES = {
    "medium, disc alpha 20, pad beta 1e-7": f"{MEDIUM} -disc_alpha 20 -pad_beta 1e-7",
    "medium, disc alpha 1, pad beta 1e-8": f"{MEDIUM} -disc_alpha 1 -pad_beta 1e-8",
    "small, disc alpha 20, pad beta 1e-7": f"{SMALL} -disc_alpha 20 -pad_beta 1e-7",
    "small, disc beta 1e-8": f"{SMALL} -disc_beta 1e-8",
    "small, undamped": SMALL,
}


def onset_counts(run):
    """Onsets, reduced eigenproblems, modes followed, full corrections."""
    return [int(count) for count in run.only(r"^(\d+) onsets: (\d+) reduced eigenproblems, (\d+) modes followed, "
                                             r"(\d+) corrections")]


def part_damped(args):
    """The stages of damped sweeps of mu."""
    rows = []
    for name, options in SCENES.items():
        run = SweepRun(args.program, args.ranks, ("massi2005",), f"{VALUES} {options}")
        rest, onsets = run.sweep_seconds, run.seconds["onsets"]
        rows.append((name, str(run.unknowns), f"{run.seconds['basis']:.2f}", f"{run.seconds['points']:.2f}",
                     f"{onsets:.2f}", *map(str, onset_counts(run)), met(onsets < rest)))
    print_table("29 values of mu: onsets are asked to take less time than basis and points together",
                ("brake", "unknowns", "basis, s", "points, s", "onsets, s", "onsets", "eigenproblems", "followed",
                 "corrections", "demand"), *rows)
