#!/usr/bin/env python3
"""Histories of explicit dynamics, transient.csv and contact_pairs.csv, against closed forms.

    verify/transient.py bar FOLDER E RHO FORCE LOSS
        a bar of 0.1 m, 1 cm^2 that touches what it strikes with 1 m/s: contact lasts 2 L / c with FORCE rho c v A; the
        impulse is 2 L / c times that; LOSS of the energy is the kinetic energy of the nodes that the blow stops
    verify/transient.py flying FOLDER LOSS
        the same with a gap before: energy lost, which the ledger has as the work of contact, in units of LOSS
    verify/transient.py exchange FOLDER
        two equal bars: both ends move with v / 2 while they touch, then the struck one has the velocity of the other
    verify/transient.py finer FOLDER FOLDER..
        what the bar's velocity misses of -v, elements halved from run to run
    verify/transient.py drop FOLDER GAP
        a bar of 0.01 kg falls by GAP (m): first contact, and the time in the air between contacts, 2 v / g, v by their
        impulse
    verify/transient.py pull FOLDER LENGTH
        a bar with one end held, the other drawn by a cosine ramp of 10 um in LENGTH (s): d'Alembert's waves
    verify/transient.py hit FOLDER
        the free end of such a bar of 100 elements gets J = 4e-3 N s at 1 us: it moves by J / (rho c A) there and back
    verify/transient.py mode FOLDER MODES NUMBER STEP
        a mode of the same mesh, step in s: u = A cos(n theta), cos theta = 1 - (omega dt)^2 / 2, exactly
    verify/transient.py thrown FOLDER V MU
        sliding block: way and time to rest under gravity, then no drift
    verify/transient.py incline FOLDER RATIO ALPHA TOLERANCE
        a force along y exceeds friction by RATIO of the weight: the block creeps with RATIO g / ALPHA; if not, it rests
    verify/transient.py pressed FOLDER STATIC FORCE
        contact forces after a ramp: their sum FORCE, and each as in static.csv of another run
    verify/transient.py hertz FOLDER APPROACH FORCE DURATION
        a ball of 10 mm against a rigid plane; what is allowed of relative errors
    verify/transient.py order LOW HIGH COLUMN FOLDER FOLDER FOLDER
        rate at which a COLUMN at the end converges, steps halved from run to run
    verify/transient.py ledger FOLDER..
        energy_error_j to the largest energy or work
"""

import csv
import math
import sys
from pathlib import Path

import numpy as np

from convergence import Judge, observed_order

G = 9.81  # m/s^2
LENGTH, AREA = 0.1, 1e-4  # of the bars, m, m^2
STEEL = (210e9, 7800.0)  # Pa, kg/m^3
LEDGER = ("kinetic_j", "strain_j", "external_work_j", "friction_work_j", "contact_work_j", "damping_work_j")


def history(folder):
    """Columns of transient.csv."""
    with (Path(folder) / "transient.csv").open(newline="") as file:
        names, *rows = list(csv.reader(file))
    return dict(zip(names, np.array(rows, float).T))


def pairs(folder, table):
    """Rows of a table of pairs, those of the last time where it has times, by place in um."""
    with (Path(folder) / table).open(newline="") as file:
        rows = list(csv.DictReader(file))
    rows = [row for row in rows if row.get("time_s") == rows[-1].get("time_s")]
    return {(round(float(row["x_m"]) * 1e6), round(float(row["y_m"]) * 1e6)): row for row in rows}


def line(judge, what, value, low, high):
    print(f"{what:62s} {value:.9g}{judge.within(value, low, high)}")


def mean(t, values, begin, end):
    """Mean with a Hann window, which forgets what rings."""
    s = (t - begin) / (end - begin)
    weight = np.where((s > 0) & (s < 1), np.sin(np.pi * s) ** 2, 0)
    return weight @ values / weight.sum()


def wave_speed(young, density):
    return math.sqrt(young / density)


def impulses(h):
    """Impulse of the contact force by row; every step has a row, the first is half a step."""
    step = np.diff(h["time_s"]).mean()
    impulse = h["normal_force_n"] * step
    impulse[0] /= 2
    return impulse


def rebound(h, mass):
    """Velocity of the struck bar's centre of mass after the contact, over that of the other before."""
    return impulses(h).sum() / mass


def bar(judge, folder, young, density, force, loss):
    h, young, density, force = history(folder), float(young), float(density), float(force)
    c, mass = wave_speed(young, density), density * AREA * LENGTH
    t, f, lasts = h["time_s"], h["normal_force_n"], 2 * LENGTH / c
    touching = np.flatnonzero(f > 0)
    line(judge, "duration / (2 L / c) - 1", (t[touching[-1]] + 0.5 * t[1]) / lasts - 1, -0.01, 0.01)
    line(judge, "rows without force in between", touching[-1] + 1 - len(touching), 0, 0)
    line(judge, "mean force / (rho c v A) - 1", mean(t, f, 0.1 * lasts, 0.9 * lasts) / (force * density * c * AREA) - 1,
         -1e-6, 1e-6)
    line(judge, "impulse / its limit - 1", rebound(h, mass) / (2 * force) - 1, -0.01, 0)
    energy = h["kinetic_j"] + h["strain_j"]
    line(judge, "energy lost / that of the layer of nodes - 1", (energy[0] - energy[1]) / energy[0] / float(loss) - 1,
         -1e-9, 1e-9)


def flying(judge, folder, loss):
    h = history(folder)
    energy = h["kinetic_j"] + h["strain_j"]
    lost = 1 - energy[-1] / energy[0]
    line(judge, "energy lost / that of the layer of nodes", lost / float(loss), 1, 1.5)
    line(judge, "work of contact / energy lost + 1", h["contact_work_j"][-1] / (lost * energy[0]) + 1, -1e-9, 1e-9)


def exchange(judge, folder):
    h = history(folder)
    lasts = 2 * LENGTH / wave_speed(*STEEL)
    for probe in ("near", "struck"):
        middle = mean(h["time_s"], h[f"{probe}_vx_m_s"], 0.1 * lasts, 0.9 * lasts)
        line(judge, f"velocity of {probe} while they touch / (v / 2) - 1", middle / -0.5 - 1, -1e-6, 1e-6)
    line(judge, "momentum that the struck bar has / m v - 1", rebound(h, STEEL[1] * AREA * LENGTH) - 1, -0.01, 0)


def finer(judge, *folders):
    missing = [2 - rebound(history(folder), STEEL[1] * AREA * LENGTH) for folder in folders]
    print("rebound, what is missing: " + ", ".join(f"{value:.4e}" for value in missing))
    for coarse, fine in zip(missing, missing[1:]):
        line(judge, "coarse / fine, element length halved", coarse / fine, 1.4, 2.2)


def drop(judge, folder, gap):
    h, gap, mass = history(folder), float(gap), 0.01
    t, f, impulse = h["time_s"], h["normal_force_n"], impulses(h)
    fall = math.sqrt(2 * gap / G)
    touching = np.flatnonzero(f > 0)
    contacts = np.split(touching, np.flatnonzero(np.diff(t[touching]) > 0.1 * fall) + 1)
    velocity, left = 0.0, 0.0
    line(judge, "contacts", len(contacts), 3, 3)
    for rows in contacts:
        flight = (t[rows[0]] - left) / (fall if left == 0 else 2 * velocity / G)
        line(judge, "time in the air / its closed form - 1", flight - 1, -1e-3, 1e-3)
        velocity += -G * (t[rows[-1]] - left) + impulse[rows].sum() / mass
        left = t[rows[-1]]


def ramp(t, length):
    return np.where(t <= 0, 0, np.where(t >= length, 1, 0.5 - 0.5 * np.cos(np.pi * t / length)))


def pull(judge, folder, length):
    h, length, size = history(folder), float(length), 1e-5
    t, c = h["time_s"], wave_speed(*STEEL)
    exact = 0
    for k in range(20):
        way = 2 * k * LENGTH
        exact = exact + ramp(t - (way + LENGTH / 2) / c, length) - ramp(t - (way + 1.5 * LENGTH) / c, length)
    line(judge, "end off the ramp / 10 um", np.abs(h["end_x_m"] / size - ramp(t, length)).max(), 0, 1e-12)
    line(judge, "middle off the waves / 10 um", np.abs(h["middle_x_m"] / size - exact).max(), 1e-9, 2e-4)


def hit(judge, folder):
    h, impulse = history(folder), 4e-3
    c, density = wave_speed(*STEEL), STEEL[1]
    t, way = h["time_s"] - 1e-6, impulse / (density * c * AREA)
    half = 2 * LENGTH / c
    first = np.flatnonzero(h["kinetic_j"] > 0)[0]
    layer = density * AREA * LENGTH / 100 / 2
    after = h["kinetic_j"][first] / (impulse**2 / (2 * layer))
    line(judge, "energy after it / (J^2 / 2 m) - 1", after - 1, -1e-12, 1e-12)
    for k, sign in ((0, -1), (1, 1)):
        at = mean(t, h["end_x_m"], (k + 0.1) * half, (k + 0.9) * half)
        line(judge, f"way / (J / (rho c A)), {'out' if sign < 0 else 'back'}, - 1", at / (sign * way) - 1, -1e-6, 1e-6)


def mode(judge, folder, modes, number, step):
    h, step = history(folder), float(step)
    with (Path(modes) / "modes.csv").open(newline="") as file:
        omega = 2 * math.pi * float(list(csv.DictReader(file))[int(number) - 1]["freq_hz"])
    u = h["tip_z_m"] / h["tip_z_m"][0]
    turn = 2 * math.asin(omega * step / 2)
    n = np.round(h["time_s"] / step)
    line(judge, "periods", n[-1] * turn / (2 * math.pi), 1.5, 1e9)
    line(judge, "displacement off cos(n theta)", np.abs(u - np.cos(n * turn)).max(), 0, 1e-8)
    line(judge, "the same without the step: not exact", np.abs(u - np.cos(omega * h["time_s"])).max(), 1e-7, 1e-2)


def thrown(judge, folder, velocity, mu):
    h, velocity, mu = history(folder), float(velocity), float(mu)
    t, y, n = h["time_s"], h["bottom_y_m"], int(h["n_closed"].max())
    way, lasts = velocity**2 / (2 * mu * G), velocity / (mu * G)
    stop, rest = np.flatnonzero(h["n_stick"] == n)[0], np.flatnonzero(h["n_stick"] < n)[-1] + 1
    line(judge, "way / (v^2 / (2 mu g)) - 1", y[-1] / way - 1, -2e-5, 2e-5)
    line(judge, "time / (v / (mu g)) - 1", t[stop] / lasts - 1, -1e-3, 1e-2)
    steady = (t > 0.2 * lasts) & (t < 0.9 * lasts)
    slope, start = np.polyfit(t[steady], h["bottom_vy_m_s"][steady], 1)
    line(judge, "time, as the line of the velocity has it - 1", -start / slope / lasts - 1, -1e-5, 1e-5)
    line(judge, "rows without any slip", len(t) - rest, 50, 1e6)
    line(judge, "drift meanwhile, m", np.ptp(y[rest:]), 0, 1e-18)
    line(judge, "largest velocity of the base meanwhile, m/s", np.abs(h["bottom_vy_m_s"][rest:]).max(), 0, 1e-18)
    stuck = [row["status"] for row in pairs(folder, "contact_pairs.csv").values()]
    line(judge, "pairs that stick at the end", stuck.count("stick"), n, n)


def incline(judge, folder, ratio, alpha, tolerance):
    h, ratio, alpha = history(folder), float(ratio), float(alpha)
    v, n, tolerance = h["bottom_vy_m_s"][-1], h["n_closed"][-1], float(tolerance)
    line(judge, "normal force / N - 1", h["normal_force_n"][-1] / G - 1, -1e-9, 1e-9)
    if ratio > 0:
        line(judge, "velocity / (g (tan - mu) / alpha) - 1", v * alpha / (G * ratio) - 1, -tolerance, tolerance)
        line(judge, "pairs that stick", h["n_stick"][-1], 0, 0)
    else:
        line(judge, "velocity, m/s", abs(v), 0, 1e-18)
        line(judge, "pairs that do not stick", n - h["n_stick"][-1], 0, 0)


def pressed(judge, folder, static, force):
    h, force = history(folder), float(force)
    mine, other = pairs(folder, "contact_pairs.csv"), pairs(static, "static.csv")
    largest = max(float(row["lambda_n_n"]) for row in other.values())
    apart = max(abs(float(row["lambda_n_n"]) - float(other[place]["lambda_n_n"])) for place, row in mine.items())
    line(judge, "contact force / load - 1", h["normal_force_n"][-1] / force - 1, -1e-6, 1e-6)
    line(judge, "pairs", len(mine), len(other), len(other))
    line(judge, "lambda_n unlike the static one / largest", apart / largest, 0, 1e-6)
    changed = sum(row["status"] != other[place]["status"] for place, row in mine.items())
    line(judge, "pairs of another status", changed, 0, 0)


def hertz(judge, folder, *bounds):
    """E* = E / (1 - nu^2), E = 105 GPa: that of steel on steel; m is that of the mesh, by the energy at the start."""
    h, radius, modulus = history(folder), 0.01, 105e9 / (1 - 0.3**2)
    t, force, speed = h["time_s"], 4 * h["normal_force_n"], -h["centre_vz_m_s"][0]
    mass = 4 * 2 * h["kinetic_j"][0] / speed**2
    approach = (15 * mass * speed**2 / (16 * modulus * math.sqrt(radius))) ** 0.4
    touching = t[force > 0]
    limits = [float(bound) for bound in bounds]
    found = ((-h["centre_z_m"].min(), approach, "approach"),
             (force.max(), 4 / 3 * modulus * math.sqrt(radius) * approach**1.5, "force"),
             (touching[-1] - touching[0], 2.943275 * approach / speed, "duration"))
    for (value, exact, name), bound in zip(found, limits):
        line(judge, f"{name} / {exact:.6g} - 1", value / exact - 1, -bound, bound)
    line(judge, "energy kept", (h["kinetic_j"] + h["strain_j"])[-1] / h["kinetic_j"][0], 0.9999, 1)


def order(judge, low, high, column, *folders):
    values = [history(folder)[column][-1] for folder in folders]
    print(f"{column}: " + ", ".join(f"{value:.12g}" for value in values))
    line(judge, "order of accuracy in the step", observed_order(*values), float(low), float(high))


def ledger(judge, *folders):
    for folder in folders:
        h = history(folder)
        left = np.abs(h["energy_error_j"]).max() / max(np.abs(h[name]).max() for name in LEDGER)
        line(judge, f"energy left over / largest, {Path(folder).name}", left, 0, 1e-9)


CHECKS = {check.__name__: check for check in (bar, flying, exchange, finer, drop, pull, hit, mode, thrown, incline,
                                              pressed, hertz, order, ledger)}


def main(what, *arguments):
    judge = Judge()
    CHECKS[what](judge, *arguments)
    return judge.failed


if __name__ == "__main__":
    sys.exit(1 if main(*sys.argv[1:]) else 0)
