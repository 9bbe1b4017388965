#!/usr/bin/env python3
"""scripts/update on bodies of eight moduli, a row of blocks and samples on a plate, whose measurements squeal makes with other moduli:

  solve     its least squares beside scipy's on a made-up model, its covariance beside that of many random measurements, directions that
            are not told
  eight     eight moduli from 20 frequencies with 0.1 % noise, and shapes with 1 % noise at few sensors: each to 0.3 %
            of samples that have modes of their own; of the row to what is stated
  held      modulus and density of a free body: only their ratio is told, a prior fixes it
  stages    an earlier update is the prior of the next: a free disc, the brake assembled, pressed and rubbing
  damping   factors of Rayleigh damping from damping ratios
  draws     where growth begins, by closed forms
  onset     friction at lock-in, and how sure it is, beside a sweep of the brake that was measured
  bad       a line each

scripts/study/updating has how often the intervals hold the truth.

    test_update.py SQUEAL"""

import csv
import math
import sys
import tempfile
from pathlib import Path

import numpy as np
import scipy.optimize
from forked import run_command
from served import sooner

SOURCE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "scripts"))
from squeal.study.updated import N, NAMES, TEST, YOUNG, Bar, Brake, row, samples  # noqa: E402
from squeal.update import solve  # noqa: E402
from squeal.update.draws import begins_of, onset_of  # noqa: E402
from squeal.update.onset import Onset  # noqa: E402
from squeal.update.written import INTERVAL, drawn_interval  # noqa: E402

FAULTS = []


def check(holds, what):
    print("ok  " if holds else "FAIL", what)
    if not holds:
        FAULTS.append(what)


def check_solve():
    """Least squares alone: Y_i = ln sum_k a_ik exp(t_k)."""
    rng = np.random.default_rng(1)
    a, truth, s = rng.random((20, 4)), np.array([0.2, -0.1, 0.05, -0.3]), 1e-2

    def model(y):
        def predict(t):
            parts = a * np.exp(t)
            return solve.Predicted((y - np.log(parts.sum(axis=1))) / s, parts / parts.sum(axis=1)[:, None] / s, None)
        return predict

    prior = solve.Prior(np.zeros(4), np.diag([0, 25.0, 0, 0]))
    y = np.log((a * np.exp(truth)).sum(axis=1)) + s * rng.normal(size=20)
    found = solve.fit(model(y), prior, 100)
    other = scipy.optimize.least_squares(lambda t: np.append((y - np.log((a * np.exp(t)).sum(axis=1))) / s, 5 * t[1]), np.zeros(4),
                                         xtol=1e-14,
                                         ftol=1e-14, gtol=1e-14)
    error = abs(found.t - other.x).max() / np.sqrt(np.diag(found.covariance)).min()
    check(found.converged and error < 2e-2, f"solve: as scipy's least squares, to {error:.1g} of a standard deviation")
    flat, trials = solve.Prior(np.zeros(4), np.zeros((4, 4))), []
    for _ in range(400):
        trials.append(solve.fit(model(np.log((a * np.exp(truth)).sum(axis=1)) + s * rng.normal(size=20)), flat, 100).t)
    ratio = np.diag(np.cov(np.array(trials).T)) / np.diag(solve.fit(model(np.log((a * np.exp(truth)).sum(axis=1))), flat, 100).covariance)
    check(abs(ratio - 1).max() < 0.25, f"solve: variances of 400 trials are {', '.join(f'{x:.2f}' for x in ratio)} of the stated ones")
    a[:, 3] = 2 * a[:, 2]  # only a sum of both is told
    found = solve.fit(model(np.log((a * np.exp([0.1, 0.1, 0.1, 0.1])).sum(axis=1))), flat, 0.5)
    direction = found.held[0][1] / abs(found.held[0][1]).max()
    check(len(found.held) == 1 and abs(direction[:2]).max() < 1e-6 and abs(found.t[:2] - 0.1).max() < 1e-3,
          "solve: a direction that is not told is held")


def check_draws():
    """Where growth begins between values of the other parameter: g = sqrt(m - 0.37) beyond a lock-in, g = m - 0.37 of damped modes; a
    lock-in that ends, and one that begins."""
    m = np.linspace(0, 1, 15)
    root, line = np.sqrt(np.maximum(m - 0.37, 0)), m - 0.37
    two = np.where(m < 0.55, root, np.sqrt(np.maximum(m - 0.81, 0)))
    found = [begins_of(m, growth) for growth in (root, line, two, 0 * m, 1 + m)]
    check(np.allclose(found[0], [0.37], atol=1e-12) and np.allclose(found[1], [0.37], atol=1e-12) and found[3:] == [[], []]
          and np.allclose(found[2], [0.37, 0.81], atol=1e-12), f"draws: growth begins at {found[:3]}")
    inf, five = np.inf, np.arange(5.0)
    cases = ((-inf, 1, -1, 3, 4), (-inf, 1, 2, 3, 4), 5 * (-inf,), (-1, -inf, 1, 2, 3), (-5, -4, -3, -2, -1), (1, 2, 3, 4, 5))
    found = [onset_of(five, np.array(case, float), 2) for case in cases]
    check(np.array_equal(found, [2.25, -inf, np.nan, np.nan, inf, -inf], equal_nan=True), f"draws: unknown growth, onsets beyond: {found}")
    draws = np.append(np.linspace(0, 1, 91), [inf] * 10)
    check(drawn_interval(draws)[1:] == (draws[2], "") and drawn_interval(np.full(30, 1.0)) == ("", "", ""),
          f"draws: those beyond count in the interval, {drawn_interval(draws)}")
    onset = Onset({"critical_value": 0.4}, first=[0.02, -0.03], steps=[np.array([0.1, 0]), np.array([0, 0.2])])
    check(abs(onset.at(np.array([0.05, 0.1])) - (0.4 + 0.02 / 2 - 0.03 / 2)) < 1e-15, "draws: the onset of a draw to first order")


def truth(rng, own=YOUNG):
    """Moduli 10 % about the scene's."""
    return dict(zip(NAMES, own * np.exp(rng.uniform(-0.1, 0.1, N))))


def check_eight(bar, name_of, demanded):
    """Eight moduli; how well they are told depends on the body."""
    rng = np.random.default_rng(11)
    values = truth(rng, bar.own)
    bar.measure(bar.run("bar.yaml", "truth", values), rng)
    rows, said = bar.update("--parameters", ",".join(NAMES), "--noise", "0.1")
    error = np.array([100 * math.log(float(rows[name]["value"]) / values[name]) for name in NAMES])
    stated = np.array([float(rows[name]["deviation_percent"]) for name in NAMES])
    largest, farthest = INTERVAL * stated.max(), (abs(error) / stated).max()
    off, stated = np.sqrt((error**2).mean()), np.sqrt((stated**2).mean())
    check(largest < demanded and off < demanded and off < 2 * stated and farthest < 3,
          f"eight: moduli of {name_of} from 20 frequencies with 0.1 % noise are {off:.3f} % rms off, at most {abs(error).max():.3f} % "
          f"and {farthest:.1f} stated deviations; "
          f"stated {stated:.3f} % rms, 95 % intervals of {largest:.3f} % at most")
    print("    ", said.strip().splitlines()[-2])
    lines = (bar.folder / "update/update.yaml").read_text().splitlines()[1:]
    check(len(lines) == N, "eight: update.yaml has all of them")
    modes, _ = bar.run("bar.yaml", "again", {line.split(":")[0]: float(line.split(":")[1].strip(' "')) for line in lines})
    with (bar.folder / "update/update_data.csv").open(newline="") as file:
        data = {row["mode"]: row for row in csv.DictReader(file)}
    check(all(math.isclose(float(row["freq_hz"]), float(data[row["mode"]]["value"]), rel_tol=1e-9) for row in modes if row["mode"] in data),
          "eight: a run with update.yaml has the frequencies that are stated")


def check_held(bar):
    """A free bar of one modulus and one density: only their ratio is told."""
    rng = np.random.default_rng(3)
    bar.measure(bar.run("free.yaml", "truth", {"b1_young": 1.05 * YOUNG, "b1_density": 8000}), rng)
    rows, said = bar.update("--parameters", "b1_young,b1_density,b2_nothing", scene="free.yaml", fails=True), ""
    check("b2_nothing" in rows and "there are" in rows, "bad: a parameter that is none, with those that there are")
    both = ",".join(f"b{k}_{name}" for k in range(1, N + 1) for name in ("young", "density"))
    rows, said = bar.update("--parameters", both, scene="free.yaml")
    check("not identified" in said, "held: moduli and densities of all blocks together have directions that are not told, and said so")
    worst = next(line for line in said.splitlines() if "not identified:" in line)
    check(all(f"b{k}_young" in worst and f"b{k}_density" in worst for k in range(1, N + 1)) and worst.count("-") < 3,
          "held: that of all of them up by as much")
    check(all(row["low_95"] == "" for row in rows.values()),
          "held: no parameter with a part in that has an interval")
    check(all(float(row["deviation_percent"]) > 100 for row in rows.values()), "held: their deviations say that nothing is known")


def check_stages(brake):
    """Stages: the free disc, the brake assembled, pressed, rubbing."""
    before, errors, chain = {}, [], True
    for _, rows, _ in brake.stages(np.random.default_rng(5)):
        now = {name: float(row["deviation_percent"]) for name, row in rows.items()}
        errors += [100 * math.log(float(row["value"]) / TEST[name]) / now[name] for name, row in rows.items()]
        chain = chain and all(now[name] <= size * (1 + 1e-9) and abs(float(rows[name]["prior_deviation_percent"]) / size - 1) < 1e-6
                              for name, size in before.items())
        before = now
    check(chain, "stages: what one knows is the prior of the next, and each knows more than the one before")
    worst = max(map(abs, errors))
    check(len(errors) == 18 and worst < 4, f"stages: {len(errors)} parameters, {worst:.1f} stated deviations off at most")
    check(before["contact_mu"] < 15, f"stages: friction to {before['contact_mu']:.0f} % by rubbing, where 30 % were known")


def check_damping(bar):
    """alpha and beta of the first block from damping ratios."""
    (bar.folder / "damped.yaml").write_text((bar.folder / "bar.yaml").read_text() + "b8_alpha: 30\nb1_beta: 1e-7\n")
    rng = np.random.default_rng(9)
    bar.measure(bar.run("damped.yaml", "truth", {"b8_alpha": 40.0, "b1_beta": 1.4e-7}), rng, noise=1e-2)
    rows, said = bar.update("--parameters", "b8_alpha,b1_beta", "--noise", "1", "--damping", "1", scene="damped.yaml")
    error = [100 * math.log(float(rows[name]["value"]) / x) for name, x in (("b8_alpha", 40), ("b1_beta", 1.4e-7))]
    stated = [float(rows[name]["deviation_percent"]) for name in ("b8_alpha", "b1_beta")]
    check(all(abs(e) < 4 * s and s < 5 for e, s in zip(error, stated)),
          f"damping: alpha and beta {error[0]:+.2f} and {error[1]:+.2f} % off, stated "
          f"{stated[0]:.2f} and {stated[1]:.2f} %")


def check_onset(brake):
    """Lock-ins over friction: how far the truth is, in stated standard deviations."""
    rng = np.random.default_rng(300)
    values = {"pad_young": 8e9 * math.exp(rng.uniform(-0.05, 0.05)), "disc_young": 2.1e11 * math.exp(rng.uniform(-0.01, 0.01))}
    found = brake.trial(values, rng, "0.5:0.75:4")
    worst = max((abs(row["off"]) for row in found), default=99)
    check(len(found) > 0 and worst < 4, f"onset: {len(found)} lock-ins, {worst:.1f} stated deviations off at most")


def main(program):
    check_solve()
    check_draws()
    with tempfile.TemporaryDirectory() as folder:
        bar = Bar(Path(folder) / "row", program, run_command, row, 19)
        check_eight(Bar(Path(folder) / "samples", program, run_command, samples, 23, 8e9), "samples", 0.3)
        check_eight(bar, "a row", 4)
        for part in (check_held, check_damping):
            part(bar)
        brake = Brake(Path(folder) / "brake", program, run_command)
        check_stages(brake)
        check_onset(brake)
    return 1 if FAULTS else 0


if __name__ == "__main__":
    with sooner(sys.argv[1]) as quick:
        sys.exit(main(quick))
