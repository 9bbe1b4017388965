"""A step in time on many ranks, from counts of PETSc's log on few: flops, messages and bytes of each rank.

    one rank solves the contact    t(P) = max(F(P) / r, c + 2 log2(P) L + B / b) + m L + h(P) / b
    all ranks do                   t(P) = F(P) / r + c / P + (M + 2 log2(P) S) L + H / b + m L + h(P) / b

F(P) flops of the rank that has most, at the rate r of one rank in the same run; c the contact of a step, which one rank solves while
those away from it go on, so that the slower of the two counts; two exchanges of it with B bytes in all; m messages and h(P) bytes of
a rank with its neighbours; L and b latency and bandwidth of the network, which are not measured but given. From 1,000 pairs on all
ranks solve (-projector_ranks): M messages and H bytes of the contact of the rank that has most, and S sums over ranks, a sweep one.
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
SPREAD = 1000  # pairs from which on all ranks solve them
LATENCY, BANDWIDTH = 2e-6, 10e9  # s, bytes/s of a cluster's network


def log_rows(program, words, ranks):
    """Of each event and rank of the steps: messages, bytes, reductions, flops of one call. PETSc counts messages received too."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log.csv"
        launch(program, ranks, [*words, "-dynamics_live", 0, "-output_dir", folder, "-ts_max_steps", STEPS, "-log_view",
                                f":{log}:ascii_csv"], f"{ranks} ranks")
        rows = {event: {} for event in EVENTS}
        with log.open(newline="") as file:
            for stage, event, rank, *numbers in (row[:9] for row in list(csv.reader(file))[1:]):
                if stage == "Dynamics" and event in rows:
                    count, _, messages, length, reductions, flops = map(float, numbers)
                    rows[event][int(rank)] = [value / count for value in (messages / 2, length / 2, reductions, flops)]
    return rows


class Counts:
    """Counts of a step: flops of each rank, the most messages and bytes that a rank sends its neighbours, bytes of the contact; the
    most messages, bytes and reductions of the contact of a rank where all solve it."""

    def __init__(self, program, words, ranks):
        bodies, kick, contact = log_rows(program, words, ranks).values()
        self.ranks = ranks
        self.flops = [bodies[rank][3] + kick[rank][3] for rank in range(ranks)]
        self.messages = max(row[0] for row in bodies.values())
        self.bytes = max(row[1] for row in bodies.values())
        self.contact = 2 * sum(row[1] for row in contact.values())
        self.imbalance = max(self.flops) * ranks / sum(self.flops)
        shared = log_rows(program, [*words, "-projector_ranks", "all"], ranks)["ContactProject"].values()
        self.shared = [max(row[i] for row in shared) for i in range(3)]

    def row(self):
        """Cells of a table."""
        return (str(self.ranks), f"{sum(self.flops):.3e}", f"{max(self.flops):.3e}", f"{self.imbalance:.2f}", f"{self.messages:.0f}",
                f"{self.bytes:.0f}", f"{self.contact:.0f}", *(f"{value:.1f}" for value in self.shared))


def step_time(counts, ranks, rate, contact, shared, fine=1):
    """Seconds of a step by the equations above; fine: times the flops, of a finer mesh; shared: all ranks solve the contact."""
    known = max((c for c in counts if c.ranks <= ranks), key=lambda c: c.ranks)
    wide = fine ** (2 / 3)
    bodies = fine * sum(counts[0].flops) / ranks * known.imbalance / rate
    if ranks == 1:
        return bodies + wide * contact
    turns = 2 * math.ceil(math.log2(ranks)) * LATENCY
    largest = max(c.bytes for c in counts if c.ranks <= max(ranks, counts[1].ranks))
    if shared:
        messages, length, sums = (max(c.shared[i] for c in counts if c.ranks <= max(ranks, 2)) for i in range(3))
        both = bodies + wide * contact / ranks + messages * LATENCY + sums * turns + wide * length / BANDWIDTH
    else:
        both = max(bodies, wide * contact + turns + wide * counts[1].contact / BANDWIDTH)
    return both + known.messages * LATENCY + wide * largest / BANDWIDTH


def print_model(program, words, one):
    """Counts and times. one: a run on one rank with seconds, its share of a processor, steps and its log."""
    counts = [Counts(program, words, ranks) for ranks in RANKS]
    contact = one.share * one.log["ContactProject"][0] / one.steps
    rate = counts[0].flops[0] / (one.share * one.seconds / one.steps - contact)
    print_table("counts of a step", ("ranks", "flops", "most of a rank", "of mean", "messages", "bytes", "bytes of contact",
                                     "all: messages", "bytes", "sums"),
                *(c.row() for c in counts))
    print(f"  one rank: {rate / 1e9:.2f} Gflop/s, contact {1e6 * contact:.1f} us; network {1e6 * LATENCY:g} us, {BANDWIDTH / 1e9:g} GB/s")
    pairs, = one.numbers(r"contact \S+: (\d+) nodes of")
    kinds = [(1, False), (64, False), (64, 16 * pairs >= SPREAD)]
    first = {kind: step_time(counts, 1, rate, contact, kind[1], kind[0]) for kind in kinds}
    rows = []
    for ranks in MODELLED:
        times = {kind: step_time(counts, ranks, rate, contact, kind[1], kind[0]) for kind in kinds}
        rows.append([str(ranks), *(cell for kind, time in times.items()
                                   for cell in (f"{1e6 * time:.0f}", f"{first[kind] / (ranks * time):.2f}"))])
    print_table("model of a step", ("ranks", "us", "efficiency", "us, edges / 4", "efficiency", "all solve, us", "efficiency"), *rows)
