#!/usr/bin/env python3
"""A restart of explicit dynamics in another scene is refused with one line that names what differs, and leaves the
checkpoint as it is: one thing is changed at a time. What a restart may change goes on, and the right scene bitwise.
Breaks when something of the scene is in no part of the checksum, in a wrong one, or counts as it is computed, not as
it is given."""

import sys

from runs import OFTEN, RESTART, compare, fail, scenes

# Option, value, and the parts that differ; all of them but for the mesh, on which more depends
CHANGES = [
    ("-model_element", "full", "the mesh"),
    ("-rig_beam_elements", "6", "the mesh..."),
    ("-pad_young", "20e9", "materials"),
    ("-disc_poisson", "0.29", "materials"),
    ("-beam_density", "78001", "materials"),
    ("-pad_alpha", "101", "materials"),
    ("-hub_set", "beam_rows", "supports"),
    ("-hub_fix", "xy", "supports"),
    ("-rows_set", "beam_top", "springs"),
    ("-rows_stiffness", "0,8.422e6,1", "springs"),
    ("-press_set", "beam_rows", "load press"),
    ("-press_force", "0,0,-50", "load press"),
    ("-press_ramp", "3e-4", "load press"),
    ("-tap_at", "0.12,0,0", "impulse tap"),
    ("-tap_part", "beam", "impulse tap"),
    ("-tap_impulse", "0,1e-9,-1e-3", "impulse tap"),
    ("-tap_time", "2e-3", "impulse tap"),
    ("-nudge_set", "beam_rows", "motion nudge"),
    ("-nudge_directions", "xy", "motion nudge"),
    ("-nudge_ramp_shape", "linear", "motion nudge"),
    ("-contact_surfaces", "disc_face,pad_face", "contact contact"),
    ("-contact_mu", "0.49", "contact contact"),
    ("-contact_mu_slope", "-0.01", "contact contact"),
    ("-contact_speed", "0.03", "contact contact"),
    ("-contact_slip", "1,0,0", "contact contact"),
    ("-contact_delay", "1e-3", "contact contact"),
    ("-contact_kinematics", "turning", "contact contact"),
    ("-edge_at", "0.115,0.005,0", "probes"),
    ("-edge_part", "beam", "probes"),
    ("-probes", "face,edge", "probes"),
    ("-disc_velocity", "0,0,1e-3", "the start"),
    ("-model_gravity", "0,0,1", "-model_gravity"),
    ("-ts_central_b", "0.6", "-ts_central_b"),
    ("-dynamics_step_fraction", "0.8", "-dynamics_step_fraction"),
    ("-dynamics_kernel", "general", "-dynamics_kernel"),
]
ALLOWED = "-dynamics_history_interval 2e-6 -dynamics_pairs_interval 2e-5 -dynamics_live 1 -projector_max_it 2000"


def refuse(runs, name, expected, *options):
    """A restart that must fail with one line, which ends as expected, or has the words before "...", and leave the
    checkpoint as it is."""
    before = runs.path(name, "checkpoint.bin").read_bytes()
    status, lines = runs.restart(name, *options)
    good = len(lines) == 1 and (expected[:-3] in lines[0] if expected.endswith("...") else lines[0].endswith(expected))
    if not status or not good:
        fail(f"{runs.scene}: restart with {' '.join(options)}: exit status {status}: {lines}")
    if runs.path(name, "checkpoint.bin").read_bytes() != before:
        fail(f"{runs.scene}: a restart that was refused changed the checkpoint")


def check_run(runs, name):
    """Another step, number of ranks, and a file that is cut short."""
    refuse(runs, name, "-ts_dt 1e-07 is another step than that of the run...", "-ts_dt", "1e-7")
    ranks = runs.arguments.ranks
    runs.arguments.ranks = 3 - ranks
    refuse(runs, name, f"was written by {ranks} rank{'s' * (ranks > 1)}, this run has {3 - ranks}")
    runs.arguments.ranks = ranks
    file = runs.path(name, "checkpoint.bin")
    whole = file.read_bytes()
    file.write_bytes(whole[:-1])
    refuse(runs, name, "is truncated...")
    file.write_bytes(whole)


def check(runs, _):
    short = ("-ts_max_time", str(0.1 * runs.arguments.end))
    name = "refused"
    runs.complete("undisturbed")
    runs.complete(name, *short, "-dynamics_checkpoint_interval", str(OFTEN))
    for option, value, parts in CHANGES:
        refuse(runs, name, f"is of another scene, which differs in: {parts}", option, value)
    check_run(runs, name)
    kept = {path: path.read_bytes() for path in (runs.folder / name).iterdir()}
    runs.complete(name, *short, *ALLOWED.split(), RESTART)
    for path, content in kept.items():
        path.write_bytes(content)
    runs.complete(name, RESTART)
    compare(runs, "undisturbed", name)
    print(f"{runs.scene}: {len(CHANGES) + 3} restarts refused, then gone on: bitwise the same", flush=True)


if __name__ == "__main__":
    sys.exit(scenes(__doc__, check))
