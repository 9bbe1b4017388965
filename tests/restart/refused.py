#!/usr/bin/env python3
"""A restart of explicit dynamics in another scene is refused with one line that names what differs, and leaves the
checkpoint as it is: one thing is changed at a time. So is an end before the checkpoint, and a table whose rows before
it are not those that were written. Intervals of what is recorded may change: rows before the checkpoint stay, those
after it come in the new intervals. The right scene goes on bitwise. Breaks when something of the scene is in no part of
the checksum, in a wrong one, or counts as it is computed, not as it is given; when rows are lost or taken unseen; or
when an interval is ignored."""

import sys

from runs import OFTEN, RESTART, compare, fail, scenes

# Option, value, and the parts that differ; all of them but for the mesh, on which more depends
CHANGES = [
    ("-model_element", "full", "the mesh"),
    ("-rig_beam_elements", "6", "the mesh..."),
    ("-rig_disc_thickness", "0.0191", "the mesh..."),
    ("-pad_young", "20e9", "materials"),
    ("-disc_poisson", "0.29", "materials"),
    ("-beam_density", "78001", "materials"),
    ("-pad_alpha", "101", "materials"),
    ("-hub_set", "beam_rows", "supports"),
    ("-hub_fix", "xy", "supports"),
    ("-rows_set", "beam_top", "spring rows"),
    ("-rows_stiffness", "0,8.422e6,1", "spring rows"),
    ("-rows_stiffness", "8.422e6,0,0", "spring rows"),
    ("-press_set", "beam_rows", "load press"),
    ("-press_force", "0,0,-50", "load press"),
    ("-press_force", "-100,0,0", "load press"),
    ("-press_ramp", "3e-4", "load press"),
    ("-tap_at", "0.12,0,0", "impulse tap"),
    ("-tap_part", "beam -tap_at 0.105,0,0.01", "impulse tap"),
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
    ("-rim_count", "8", "circles"),
    ("-rim_face", "z-", "circles"),
    ("-disc_velocity", "0,0,1e-3", "the start"),
    ("-model_gravity", "0,0,1", "-model_gravity"),
    ("-ts_central_b", "0.6", "-ts_central_b"),
    ("-dynamics_step_fraction", "0.8", "-dynamics_step_fraction"),
    ("-dynamics_kernel", "general", "-dynamics_kernel"),
]
ALLOWED = """-dynamics_history_interval 2e-6 -dynamics_pairs_interval 2e-5 -dynamics_snapshot_interval 1e-4 -dynamics_live 1
             -dynamics_checkpoint_interval 1000 -projector_max_it 2000"""


INTERVALS = {"transient.csv": 2e-6, "contact_pairs.csv": 2e-5}  # s, of ALLOWED: twice those of before


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


def check_filters(runs, name):
    """Amplitudes of modes that the run before did not record."""
    refuse(runs, name, "is of another scene, which differs in: -dynamics_filters...", *runs.watch("1"))


def check_end(runs, name):
    """An end before the checkpoint, in time or in steps."""
    refuse(runs, name, "would be lost: give a later end, or start anew with another -output_dir", "-ts_max_time", "1e-4")
    refuse(runs, name, "would be lost: give more, or start anew with another -output_dir", "-ts_max_steps", "7")


def check_rows(runs, name):
    """A digit of an early row, of each table."""
    for table in ("transient.csv", "contact_pairs.csv", "circles.csv"):
        path = runs.path(name, table)
        whole = path.read_bytes()
        at = whole.index(b"\n") + 20
        at = next(i for i in range(at, len(whole)) if whole[i:i + 1] in b"123456789")
        path.write_bytes(whole[:at] + (b"1" if whole[at:at + 1] != b"1" else b"2") + whole[at + 1:])
        refuse(runs, name, "its rows before the checkpoint are not those that were written; start the run anew")
        if runs.path(name, table + ".part").exists():
            fail(f"{runs.scene}: a restart that was refused renamed {table}")
        path.write_bytes(whole)


def rows_apart(lines):
    """Times of rows, each once, s."""
    return sorted({float(line.split(",")[0]) for line in lines})


def check_intervals(runs, name, end):
    """Rows up to the checkpoint are those of before; then they come in the intervals of the restart."""
    before = {table: runs.path(name, table).read_text().splitlines()[1:] for table in INTERVALS}
    runs.complete(name, "-ts_max_time", str(3 * end), *ALLOWED.split(), RESTART)
    for table, interval in INTERVALS.items():
        after = runs.path(name, table).read_text().splitlines()[1:]
        unlike = (i for i, lines in enumerate(zip(before[table], after)) if lines[0] != lines[1])
        same = next(unlike, len(before[table]))
        new = rows_apart(after[same:])
        if len(rows_apart(before[table][:same])) < 0.5 * end / (interval / 2):
            fail(f"{runs.scene}: only {same} of {len(before[table])} rows of {table} stay at a restart")
        if len(new) < 3 or any(abs((b - a) / interval - 1) > 0.05 for a, b in zip(new, new[1:])):
            fail(f"{runs.scene}: {table} after a restart has rows at {new[:5]}, not {interval} s apart")
        if abs(new[-1] - 3 * end) > interval:
            fail(f"{runs.scene}: {table} ends at {new[-1]} s")
    frames = len(list(runs.folder.glob(f"{name}/snapshot_*.h5")))
    if not 2 * end / 1e-4 <= frames <= 1 + 3 * end / 1e-4:
        fail(f"{runs.scene}: {frames} snapshots after a restart with another interval")


def put_back(runs, name, kept):
    """The folder as it was."""
    for path in (runs.folder / name).iterdir():
        path.unlink()
    for path, content in kept.items():
        path.write_bytes(content)


def check(runs, _):
    end = 0.1 * runs.arguments.end
    short = ("-ts_max_time", str(end))
    name = "refused"
    runs.complete("undisturbed")
    runs.complete(name, *short, "-dynamics_checkpoint_interval", str(OFTEN))
    for option, value, parts in CHANGES:
        refuse(runs, name, f"is of another scene, which differs in: {parts}", option, *value.split())
    check_run(runs, name)
    check_end(runs, name)
    check_filters(runs, name)
    kept = {path: path.read_bytes() for path in (runs.folder / name).iterdir()}
    check_rows(runs, name)
    put_back(runs, name, kept)
    check_intervals(runs, name, end)
    put_back(runs, name, kept)
    runs.complete(name, RESTART)
    compare(runs, "undisturbed", name)
    print(f"{runs.scene}: {len(CHANGES) + 8} restarts refused, then gone on: bitwise the same", flush=True)


if __name__ == "__main__":
    sys.exit(scenes(__doc__, check))
