"""What scripts/update writes and prints."""

import math

import numpy

from ..response.record import write_rows
from ..tables import BadInput, print_table, read_table, whole

PARAMETERS = ("parameter", "unit", "start", "value", "low_95", "high_95", "deviation_percent", "prior_deviation_percent", "held_percent")
READ = {"parameter": str, "value": float, "held_percent": float}
INTERVAL = 1.959963984540054  # standard deviations to each side of a 95 % interval
BENT = 0.3  # of the standard deviation of an onset, that the curve moves it by
ONSETS = ("parameter", "critical_value", "low_95", "high_95", "deviation", "second_order", "freq_hz", "kind", "label", "draws",
          "draws_low_95", "draws_high_95")
LEFT = 1.0  # per cent of its own direction that the data do not tell, from which on a parameter is not identified
OPEN = 1e3  # deviation from which on nothing is known
ROUNDING = 1e-12  # of a direction
FEW = 0.1  # of the largest part of a direction: what is not named


def held_share(fit, k):
    """Per cent of a parameter's own direction that the data do not tell."""
    return 100 * math.sqrt(sum(vector[k]**2 for _, vector in fit.held))


def deviation_of(fit, k):
    """Standard deviation of a parameter, with its part of the directions that are held: what the data leave open there is unknown too."""
    return math.sqrt(fit.covariance[k, k] + sum((min(size, OPEN) * vector[k])**2 for size, vector in fit.held if abs(vector[k]) > ROUNDING))


def parameter_rows(model, fit, prior):
    """Rows of update.csv."""
    before = numpy.sqrt(numpy.diag(numpy.linalg.inv(prior.weight + numpy.eye(len(prior.weight)) / OPEN**2)))  # with all others unknown
    for k, (name, value) in enumerate(model.values(fit.t).items()):
        deviation, left = deviation_of(fit, k), held_share(fit, k)
        ends = [value * math.exp(sign * INTERVAL * deviation) for sign in (-1, 1)] if left < LEFT else ("", "")
        yield (name, model.units[name], model.start[name], value, *ends, 100 * deviation, 100 * before[k] if before[k] < OPEN / 2 else "",
               left)


def write_all(model, fit, prior, output):
    """Tables, a scene with the parameters, and one that samples them."""
    names = list(model.start)
    write_rows(output / "update.csv", PARAMETERS, parameter_rows(model, fit, prior))
    write_rows(output / "update_covariance.csv", ("parameter", *names),
               [(name, *map(float, row)) for name, row in zip(names, fit.covariance)])
    before = {one[:2]: one for one in fit.first.what.data}
    write_rows(output / "update_data.csv", ("quantity", "measured", "mode", "measured_value", "start_value", "value", "residual"), [
        (one[0], one[1], one[5], *(float(math.exp(x) if one[0] == "frequency" else x) for x in (one[2], before[one[:2]][3], one[3])),
         float((one[2] - one[3]) / one[4])) for one in fit.last.what.data])
    with whole(output / "update.yaml") as part:
        part.write_text("# Parameters of scripts/update, to stack on the scene by -options_file\n"
                        + scene_lines(model, fit), encoding="utf-8")
    write_sample(model, fit, output / "update_sample.yaml")


def scene_lines(model, fit):
    """The parameters as a scene has them."""
    return "".join(f"{name}: \"{text}\"\n" for name, text in model.texts(model.values(fit.t)).items())


def write_sample(model, fit, path):
    """Distributions of the parameters, as factors of their values, with their correlations, for -analysis sample."""
    deviation = numpy.sqrt(numpy.diag(fit.covariance))
    known = [k for k, one in enumerate(deviation) if one > 0 and held_share(fit, k) < LEFT]
    names = list(model.start)
    correlation = [f"{names[i]}:{names[k]}:{fit.covariance[i, k] / deviation[i] / deviation[k]:.6f}" for n, i in enumerate(known)
                   for k in known[:n]]
    with whole(path) as part, part.open("w", encoding="utf-8") as out:
        out.write("# What scripts/update knows of the parameters, to stack on the scene by -options_file\nanalysis: sample\n"
                  + scene_lines(model, fit))
        out.write(f"sample_variables: \"{','.join(names[k] for k in known)}\"\n")
        for k in known:
            out.write(f"{names[k]}_distribution: lognormal\n{names[k]}_relative: true\n{names[k]}_mean: 1\n{names[k]}_deviation: "
                      f"{deviation[k]:.6g}\n")
        if correlation:
            out.write(f"sample_correlations: \"{','.join(correlation)}\"\n")


def direction_words(model, vector):
    """disc_young 1, disc_density 1 of a direction, the largest part positive."""
    vector = vector / vector[abs(vector).argmax()]
    return " with ".join(f"{name} {x:+.2g}" for name, x in zip(model.start, vector) if abs(x) >= FEW)


def print_all(model, fit, prior):
    """The answer for people."""
    rows = list(parameter_rows(model, fit, prior))
    print_table("parameters", ("name", "start", "value", "95 % from", "to", "unit", "+- %", "prior +- %"),
                *((row[0], f"{row[2]:.6g}", f"{row[3]:.6g}", f"{row[4]:.6g}", f"{row[5]:.6g}", row[1] or "-", f"{INTERVAL * row[6]:.3g}",
                   f"{INTERVAL * row[7]:.3g}" if row[7] else "-") if row[8] < LEFT else
                  (row[0], f"{row[2]:.6g}", f"{row[3]:.6g}", "not", "identified", row[1] or "-", "-", "-") for row in rows))
    for deviation, vector in fit.held:
        size = f"a change by {100 * deviation:.3g} %" if deviation < OPEN else "no change"
        print(f"not identified: {direction_words(model, vector)} together: {size} would show in the data; held at the start. A prior, or "
              f"other "
              "measurements, fix it")
    data = fit.last.what.data
    for quantity in ("frequency", "damping"):
        some = [[(one[2] - one[3]) for one in which.what.data if one[0] == quantity] for which in (fit.first, fit.last)]
        if some[1]:
            before, after = (math.sqrt(numpy.mean(numpy.square(one))) for one in some)
            scale, unit = (100, "%") if quantity == "frequency" else (1, "")
            print(f"{len(some[1])} {'frequencies' if quantity == 'frequency' else 'damping ratios'}: {scale * before:.3g} {unit} rms off "
                  f"at the "
                  f"start, {scale * after:.3g} {unit} now".replace(" ,", ","))
    free = len(data) - (len(rows) - len(fit.held) - int((numpy.diag(prior.weight) > 0).sum()))
    if free > 0:
        ratio = math.sqrt(fit.chi2 / free)
        print(f"what is left is {ratio:.2f} of the stated noise, with {free} degrees of freedom" + (
            ": TOO MUCH: the model cannot be so, the noise is larger, or a pair is wrong; intervals are too narrow" if ratio > 2 else ""))
    print(f"{fit.models} models, {model.runs} runs, {model.seconds:.1f} s of a processor" + ("" if fit.converged else "; NOT CONVERGED"))


def drawn_interval(draws):
    """Of how many draws the onset is known, also as beyond the values, and its 95 % interval; nothing of fewer than 40, and no end that is
    beyond the values."""
    known = draws[~numpy.isnan(draws)] if draws is not None else ()
    if len(known) < 40:
        return "", "", ""
    ends = numpy.quantile(known, 0.025, method="lower"), numpy.quantile(known, 0.975, method="higher")
    return (len(known), *(float(end) if math.isfinite(end) else "" for end in ends))


def said_of_draws(draws, known, low, high):
    """A line for the interval of draws."""
    beyond, middle = int(numpy.isinf(draws).sum()), numpy.quantile(draws[~numpy.isnan(draws)], 0.5, method="nearest")
    if numpy.isinf(middle):
        return f"  of {len(draws)} draws {beyond} have it beyond what was drawn, or another mode near that grows there"
    ends = [f"{end:.5g}" if end != "" else "beyond what was drawn" for end in (low, high)]
    return (f"  of {len(draws)} draws: {middle:.5g}, 95 % from {ends[0]} to {ends[1]}" + (f"; {beyond} are beyond" if beyond else "")
            + (f"; of {len(draws) - known} it is not known" if known < len(draws) else ""))


def tell_onsets(name, onsets, output):
    """Writes and prints the onsets with their intervals, of which that of the sweep itself is part."""
    rows = []
    for one in onsets:
        deviation = math.hypot(one.deviation(), one.row["error_estimate"]) if one.first else math.nan
        value = one.row["critical_value"]
        rows.append((name, value, *((value - INTERVAL * deviation, value + INTERVAL * deviation, deviation, one.bend())
                                    if math.isfinite(deviation) else 4 * [""]), one.row["freq_hz"], one.row["kind"], one.row["label"],
                     *drawn_interval(one.draws)))
        if math.isfinite(deviation):
            said = f"+- {INTERVAL * deviation:.2g} (95 %)" + (
                ", whose dependence is bent: -analysis sample tells more" if abs(one.bend()) > BENT * deviation else "")
        else:
            said = "but not for all parameters within their intervals"
        print(f"{one.row['kind'].replace('_', ' ')} at {name} = {value:.5g} {said}, {one.row['freq_hz']:.1f} Hz {one.row['label']}")
        if rows[-1][-3]:
            print(said_of_draws(one.draws, *rows[-1][-3:]))
    if not rows:
        print(f"no onset over {name}")
    write_rows(output / "update_onsets.csv", ONSETS, rows)


def read_prior(path, names):
    """Values and covariance of an earlier update.csv for these parameters; those that it did not have or identify are left out."""
    rows = {row["parameter"]: row for row in read_table(path, READ)}
    known = [name for name in names if name in rows and rows[name]["held_percent"] < 50]
    if not known:
        raise BadInput(f"{path}: has none of the parameters {', '.join(names)}")
    table = {row["parameter"]: row for row in read_table(path.with_name("update_covariance.csv"),
                                                         {"parameter": str, **dict.fromkeys(known, float)})}
    covariance = numpy.array([[table[a][b] for b in known] for a in known])
    return {name: rows[name]["value"] for name in known}, covariance
