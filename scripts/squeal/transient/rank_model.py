"""A step in time on many ranks, from counts of PETSc's log on few: flops, messages and bytes of each rank.

    t(P) = max(F(P) / r, c + 2 log2(P) L + B / b) + m L + h(P) / b

F(P) flops of the rank that has most, at the rate r of one rank in the same run; c the contact of a step, which one rank solves while
those away from it go on, so that the slower of the two counts; two collective messages of it with B bytes in all; m messages and h(P)
bytes of a rank with its neighbours; L and b latency and bandwidth of the network, which are not measured but given.
Between the counts and beyond them F(P) = F(1) / P times the imbalance, and h(P) the largest, of the largest number counted: parts
that are cut along the sweep keep their bytes, and those cut in the plane too have less.
"""

import csv
import math
import tempfile
from pathlib import Path

from ..run.program import launch
from ..tables import print_table

EVENTS = ("BodiesAdvance", "KickAndDrift", "ContactProject")
RANKS = (1, 2, 3, 4, 8, 16, 32)  # counted, on any number of cores
MODELLED = (1, 2, 4, 8, 16, 32, 64, 128, 256)
STEPS = 10
LATENCY, BANDWIDTH = 2e-6, 10e9  # s, bytes/s of a cluster's network


class Counts:
    """Counts of a step: flops of each rank, the most messages and bytes that a rank sends its neighbours, bytes of the contact."""

    def __init__(self, program, words, ranks):
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "log.csv"
            launch(program, ranks, [*words, "-dynamics_live", 0, "-output_dir", folder, "-ts_max_steps", STEPS, "-log_view",
                                    f":{log}:ascii_csv"], f"{ranks} ranks")
            rows = {event: {} for event in EVENTS}
            with log.open(newline="") as file:
                for stage, event, rank, *numbers in (row[:9] for row in list(csv.reader(file))[1:]):
                    if stage == "Dynamics" and event in rows:
                        count, _, messages, length, _, flops = map(float, numbers)
                        rows[event][int(rank)] = [value / count for value in (messages, length, flops)]
        bodies, kick, contact = (rows[event] for event in EVENTS)
        self.ranks = ranks
        self.flops = [bodies[rank][2] + kick[rank][2] for rank in range(ranks)]
        self.messages = max(row[0] for row in bodies.values()) / 2  # PETSc counts those received too
        self.bytes = max(row[1] for row in bodies.values()) / 2
        self.contact = sum(row[1] for row in contact.values())
        self.imbalance = max(self.flops) * ranks / sum(self.flops)

    def row(self):
        """Cells of a table."""
        return (str(self.ranks), f"{sum(self.flops):.3e}", f"{max(self.flops):.3e}", f"{self.imbalance:.2f}", f"{self.messages:.0f}",
                f"{self.bytes:.0f}", f"{self.contact:.0f}")


def step_time(counts, ranks, rate, contact, fine=1):
    """Seconds of a step by the equation above; fine: times the flops, of a finer mesh."""
    known = max((c for c in counts if c.ranks <= ranks), key=lambda c: c.ranks)
    wide = fine ** (2 / 3)
    bodies = fine * sum(counts[0].flops) / ranks * known.imbalance / rate
    if ranks == 1:
        return bodies + wide * contact
    largest = max(c.bytes for c in counts if c.ranks <= max(ranks, counts[1].ranks))
    both = max(bodies, wide * contact + 2 * math.ceil(math.log2(ranks)) * LATENCY + wide * counts[1].contact / BANDWIDTH)
    return both + known.messages * LATENCY + wide * largest / BANDWIDTH


def print_model(program, words, one):
    """Counts and times. one: a run on one rank with seconds, its share of a processor, steps and its log."""
    counts = [Counts(program, words, ranks) for ranks in RANKS]
    contact = one.share * one.log["ContactProject"][0] / one.steps
    rate = counts[0].flops[0] / (one.share * one.seconds / one.steps - contact)
    print_table("counts of a step", ("ranks", "flops", "most of a rank", "of mean", "messages", "bytes", "bytes of contact"),
                *(c.row() for c in counts))
    print(f"  one rank: {rate / 1e9:.2f} Gflop/s, contact {1e6 * contact:.1f} us; network {1e6 * LATENCY:g} us, {BANDWIDTH / 1e9:g} GB/s")
    first = {fine: step_time(counts, 1, rate, contact, fine) for fine in (1, 64)}
    rows = []
    for ranks in MODELLED:
        times = {fine: step_time(counts, ranks, rate, contact, fine) for fine in first}
        rows.append([str(ranks), *(cell for fine, time in times.items()
                                   for cell in (f"{1e6 * time:.0f}", f"{first[fine] / (ranks * time):.2f}"))])
    print_table("model of a step", ("ranks", "us", "efficiency", "us, edges / 4", "efficiency"), *rows)
