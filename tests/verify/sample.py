#!/usr/bin/env python3
"""Tables of -analysis sample beside scipy.

    sample.py probability RESULTS       flutter of options/oscillator_sample.yaml: closed form, moments, quantiles, interval, regression
    sample.py ishigami RESULTS SEQUENCE indices of Ishigami's function, which the growth of one mode is, within three of their errors
    sample.py draws RESULTS SEQUENCE    distributions of tests/cases/sample.toml, and how evenly a sequence fills them
    sample.py table FILE                writes the distribution of sin x, x uniform in (-pi, pi)"""

import csv
import math
import sys
from pathlib import Path

import numpy
from scipy import stats

A, B = 7, 0.1  # f = sin x1 + A sin^2 x2 + B x3^4 sin x1
TEXTS = "branch", "label", "of", "variable", "class"
FAULTS = []


def check(what, holds, value):
    print(f"{'ok  ' if holds else 'FAIL'} {what}: {value}")
    if not holds:
        FAULTS.append(what)


def close(what, value, expected, tolerance):
    worst = float(numpy.max(numpy.abs(numpy.asarray(value) - numpy.asarray(expected))))
    check(what, worst <= tolerance, f"{worst:.2e} from the reference, {tolerance:.0e} allowed")


def read(path):
    """Columns: numbers, nan for none, or texts, as of branch."""
    with path.open(newline="") as table:
        rows = list(csv.DictReader(table))
    return {name: numpy.array([row[name] if name in TEXTS else float(row[name] or "nan") for row in rows]) for name in rows[0]}


def probability(folder):
    samples, modes, rows, index = (read(folder / f"{name}.csv") for name in ("samples", "samples_modes", "probability", "indices"))
    mu, n = samples["friction"], len(samples["friction"])
    root = numpy.sqrt((1 - 4 / 3 * mu).astype(complex))  # kappa = 2 +- root
    largest = numpy.sqrt(-(2 + root)).real.clip(0), numpy.sqrt(-(2 - root)).real.clip(0)
    close("growth of all samples", samples["growth_rad_s"], numpy.abs(numpy.maximum(*largest)), 1e-8)
    grows = int((1 - 4 / 3 * mu < 0).sum())
    any_mode = rows["branch"] == "any"
    check("count", rows["unstable"][any_mode][0] == grows and samples["unstable"].sum() == grows, grows)
    close("probability", rows["probability"][any_mode][0], stats.norm.sf(0.5), 2 / n)
    ends = [stats.beta.ppf(0.025, grows, n - grows + 1), stats.beta.ppf(0.975, grows + 1, n - grows)]
    close("Clopper-Pearson", [rows["probability_lower"][any_mode][0], rows["probability_upper"][any_mode][0]], ends, 1e-12)
    for k, branch in enumerate(rows["branch"][~any_mode]):
        own = modes["branch"] == branch
        for kind, unit, name in (("freq", "_hz", "freq_hz"), ("growth", "_rad_s", "growth_rad_s")):
            values = modes[name][own].astype(float)
            close(f"{name} of {branch}: moments", [rows[f"{kind}_mean{unit}"][k], rows[f"{kind}_deviation{unit}"][k]],
                  [values.mean(), values.std(ddof=1)], 1e-12)
            close(f"{name} of {branch}: quantiles", [rows[f"{kind}_{q}{unit}"][k] for q in (1, 5, 50, 95, 99)],
                  numpy.quantile(values, [0.01, 0.05, 0.5, 0.95, 0.99]), 1e-12)
        line = stats.linregress(mu[modes["sample"][own].astype(int) - 1], modes["freq_hz"][own].astype(float))
        at = (index["branch"] == branch) & (index["of"] == "freq_hz")
        close(f"regression of {branch}", [index["slope"][at][0], index["r_squared"][at][0]], [line.rvalue, line.rvalue**2], 1e-10)
        close(f"its error of {branch}", index["slope_error"][at][0], abs(line.rvalue * line.stderr / line.slope), 1e-10)


def ishigami(folder, sequence):
    index = read(folder / "indices.csv")
    at = (index["of"] == "growth_rad_s") & (index["branch"] == "any")
    variance = A**2 / 8 + B * math.pi**4 / 5 + B**2 * math.pi**8 / 18 + 0.5
    first = [0.5 * (1 + B * math.pi**4 / 5)**2, A**2 / 8, 0]
    both = 8 * B**2 * math.pi**8 / 225
    total = [first[0] + both, first[1], both]
    for name, reference in (("first", first), ("total", total)):
        value, error = index[name][at].astype(float), index[f"{name}_error"][at].astype(float)
        ratio = numpy.abs(value - numpy.array(reference) / variance) / error
        print(name, value, numpy.array(reference) / variance, error)
        check(f"{sequence}, {name}: within three standard errors", len(ratio) == 3 and ratio.max() <= 3, ratio)
        check(f"{sequence}, {name}: errors that say something", (error > 0).all() and error.max() < 0.08, error)
    samples = read(folder / "samples.csv")
    a, b, c = (samples[name] for name in ("x1", "x2", "x3"))
    close("the mode that grows as Ishigami's function", samples["growth_rad_s"], a + A * b**2 + B * c**4 * a, 1e-9)


def draws(folder, sequence):
    samples = read(folder / "samples.csv")
    n = len(samples["u1"])
    shape = math.sqrt(math.log1p(0.04))
    normal = stats.truncnorm((0.8 - 1) / 0.1, (1.15 - 1) / 0.1, 1, 0.1)
    known = {"u1": normal, "u2": stats.lognorm(shape, scale=math.exp(-shape**2 / 2)), "u3": stats.uniform(0.9, 0.3),
             "u4": stats.triang(0.25, 1, 2), "u5": stats.norm(1, 0.1), "u6": stats.norm(1, 0.2)}
    score = {name: stats.norm.ppf(of.cdf(samples[name])) for name, of in known.items()}
    # Largest distance of the distribution functions: for random points 1.95 / sqrt(n) is exceeded once in 1,000
    most = {"sobol": 8 / n, "latin": 1.01 / n, "random": 1.95 / math.sqrt(n)}[sequence]
    for name, of in known.items():
        if sequence != "random" and name == "u6":
            continue  # made of u5's points and its own
        check(f"{sequence}, {name}", stats.kstest(samples[name], of.cdf).statistic <= most, stats.kstest(samples[name], of.cdf).statistic)
    table = numpy.interp(samples["u7"], [1, 2, 4], [0, 0.5, 1])
    check(f"{sequence}, u7", stats.kstest(table, "uniform").statistic <= most, stats.kstest(table, "uniform").statistic)
    close(f"{sequence}: correlation", numpy.corrcoef(score["u5"], score["u6"])[0, 1], 0.8, 0.03)
    close(f"{sequence}: no other", numpy.corrcoef(score["u1"], score["u6"])[0, 1], 0, 0.1)


def main():
    if sys.argv[1] == "table":
        sine = numpy.cos(numpy.linspace(math.pi, 0, 2001))
        probability_below = 0.5 + numpy.arcsin(sine) / math.pi
        probability_below[0], probability_below[-1] = 0, 1
        lines = "".join(f"{a!r},{b!r}\n" for a, b in zip(sine.tolist(), probability_below.tolist()))
        Path(sys.argv[2]).write_text("value,probability\n" + lines)
        return
    {"probability": probability, "ishigami": ishigami, "draws": draws}[sys.argv[1]](Path(sys.argv[2]), *sys.argv[3:])
    if FAULTS:
        sys.exit(f"FAILED: {len(FAULTS)}")


if __name__ == "__main__":
    main()
