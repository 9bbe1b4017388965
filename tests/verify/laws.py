#!/usr/bin/env python3
"""Laws of motion and friction in time by second paths: places of nodes (snapshot_*.h5) and normal forces of pairs (contact_pairs.csv)
of every step stand in place of the velocities and forces that the run had within its steps. Prints measured and allowed.

    laws.py block RESULTS LIMIT KEY=VALUE...    a block on a base, on the mesh
    laws.py off RESULTS LIMIT KEY=VALUE...      how far the error that is seen is from 1e-6, where mu is wrong by that
    laws.py reduced RESULTS LIMIT KEY=VALUE...  the same of a reduced model, without momentum
    laws.py free RESULTS LIMIT DENSITY...       bodies that nothing holds: momentum stays; one of each part, kg/m^3
    laws.py recurrence RESULTS LIMIT            the bar of one element of tests/cases/hard_time.toml, pushed, step by step
    laws.py fall RESULTS LIMIT DENSITY          its bar that falls, part 1: momentum comes from its weight and the normal force

KEY is mu; slope of mu over speed (s/m) about the speed of the base (m/s, along -y) and its ramp (s), turns=1 where it moves in a frame of
its own; of momentum: density, alpha (1/s), gravity (m/s^2), ky and kz at each node of the block (N/m), press (N) and its ramp
`pressing` (s), b of the scheme. With the slips s_n = P (u_{n+1} - u_n) + way of the base from places, T_n = mu lambda_n s_n / |s_n|,

    |lambda_t| = mu lambda_n where a pair slips, s_n = 0 where it sticks,
    heat of a step = sum T_n . (s_{n-1} + s_n) / 2,
    M (u_{n+1} - 2 u_n + u_{n-1}) / dt^2 = (1/2 - b) F_{n-1} + (1/2 + b) F_n,     F all that acts on the block."""

import csv
import sys
from pathlib import Path

import h5py
import numpy


def rows(results, name):
    with (Path(results) / name).open(newline="") as table:
        return list(csv.DictReader(table))


def column(table, name):
    return numpy.array([float(row[name]) for row in table])


def largest(error, size):
    return abs(error).max() / abs(size).max()


def judge(errors, limit):
    print(", ".join(f"{name} {error:.1e}" for name, error in errors.items()))
    print(f"measured {max(errors.values()):.3e}, allowed {limit:g}")
    return 0 if all(0 <= error <= limit for error in errors.values()) else 1


def ramp(t, length):
    return 0.5 * (1 - numpy.cos(numpy.pi * numpy.clip(t / length, 0, 1))) if length else numpy.ones_like(t)


def ramp_integral(t, length):
    x = numpy.clip(t / length, 0, 1)
    return length * 0.5 * (x - numpy.sin(numpy.pi * x) / numpy.pi) + numpy.maximum(t - length, 0)


class Film:
    """Displacements and velocities [steps][nodes][3] (m, m/s), places, part and volume (m^3) of each node; cells are bricks."""

    def __init__(self, results):
        files = [h5py.File(path)["VTKHDF"] for path in sorted(Path(results).glob("snapshot_*.h5"))]
        self.x = files[0]["Points"][()]
        self.u, self.v = (numpy.array([f["PointData"][name][()] for f in files]) for name in ("displacement_m", "velocity_m_s"))
        self.part, self.volume = numpy.zeros(len(self.x), int), numpy.zeros(len(self.x))
        for cell, part in zip(files[0]["Connectivity"][()].reshape(-1, 8), files[0]["CellData/part"][()]):
            self.part[cell] = part
            self.volume[cell] += numpy.ptp(self.x[cell], axis=0).prod() / 8


class Slider:
    """Pairs of a block, which is part 1, at t_0, t_1, ...: normal and tangential force, N, steps of the displacement and ways
    of the base beneath it, m, [steps][pairs]; heat of the steps, J."""

    def __init__(self, results, key):
        pairs = rows(results, "contact_pairs.csv")
        self.key, self.film = key, Film(results)
        self.t = numpy.unique(column(pairs, "time_s"))
        n, dt = len(pairs) // len(self.t), numpy.diff(self.t)
        self.normal, self.tangential = (column(pairs, name).reshape(-1, n) for name in ("lambda_n_n", "lambda_t_n"))
        self.status = numpy.array([row["status"] for row in pairs]).reshape(-1, n)
        mine = numpy.flatnonzero(self.film.part == 1)
        place = numpy.column_stack([column(pairs[:n], name) for name in ("x_m", "y_m", "z_m")])
        self.node = mine[abs(self.film.x[mine][:, None] - place).sum(axis=2).argmin(axis=0)]
        self.u = self.film.u[-len(self.t):]
        self.step = numpy.diff(self.u[:, self.node, :2], axis=0)
        speed, length = key.get("speed", 0), key.get("ramp", 0)
        self.way = speed * (numpy.diff(ramp_integral(self.t, length)) if key.get("turns") else dt * ramp(self.t[:-1] + dt / 2, length))
        table = rows(results, "transient.csv")[-len(self.t):]
        if not numpy.allclose(column(table, "time_s"), self.t, rtol=1e-12, atol=0) or len(self.u) < len(self.t):
            sys.exit("rows, pairs and snapshots must be of every step")
        self.heat = numpy.diff(column(table, "friction_heat_j"))

    def slips(self, step, way):
        """Vectors and their lengths, m."""
        s = step + numpy.stack([0 * way, way], axis=-1)[:, None]
        return s, numpy.hypot(s[:, :, 0], s[:, :, 1])

    def laws(self, at, s, mu):
        """Errors of the law of the pairs at the times `at` that slip by s meanwhile, and T, N."""
        length = numpy.hypot(s[:, :, 0], s[:, :, 1])
        slips, sticks = self.status[at] == "slip", self.status[at] == "stick"
        miss = numpy.where(slips, self.tangential[at] - mu * self.normal[at], 0)
        T = numpy.where(slips, mu * self.normal[at] / numpy.where(slips, length, 1), 0)[:, :, None] * s
        print(f"{slips.sum()} slip, {sticks.sum()} stick")
        if slips.sum() < 100:
            sys.exit("must slip")
        return {"mu": largest(miss, self.normal), "stuck": (sticks * length).max() / length.max()}, T


def errors_of_block(results, key):
    """The base slides in both halves of a step as in its middle; mu is that of the slip speeds before, extrapolated to t_n."""
    run = Slider(results, key)
    s, _ = run.slips(run.step[2:], run.way[2:])
    before, length = run.slips(run.step[1:-1], run.way[2:])
    _, earlier = run.slips(run.step[:-2], run.way[1:-1])
    speed = numpy.maximum(0, 1.5 * length - 0.5 * earlier) / (run.t[1] - run.t[0])
    errors, T = run.laws(slice(2, -1), s, key["mu"] + key.get("slope", 0) * (speed - key.get("speed", 0)))
    heat, sliding = (T * (before + s)).sum(axis=(1, 2)) / 2, (run.status[2:-1] != "stick").all(axis=1)
    errors["heat"] = largest((run.heat[2:] - heat)[sliding], heat)  # what ends in stick has the direction of no slip
    if "density" in key:
        errors["momentum"] = momentum(run, key, T)
    return errors


def block(results, limit, key):
    return judge(errors_of_block(results, key), limit)


def off(results, limit, key):
    """A law that is 1e-6 off shows as 1e-6: in the friction of the pair of the largest force, in all heat."""
    errors = errors_of_block(results, {**key, "mu": key["mu"] * (1 + 1e-6)})
    return judge({"mu": abs(errors["mu"] / (1e-6 * key["mu"]) - 1), "heat": abs(errors["heat"] / 1e-6 - 1)}, limit)


def momentum(run, key, T):
    """Of the block, at steps from t_3 on, whose forces and those before are known."""
    mine, dt, b, t = run.film.part == 1, run.t[1] - run.t[0], key.get("b", 0.5), run.t[2:-1]
    m = key["density"] * run.film.volume[mine]
    u, push = run.u[:, mine], m @ numpy.diff(run.u[:, mine], axis=0) / dt
    F = numpy.zeros((len(t), 3))
    F[:, :2] -= T.sum(axis=1)
    F[:, 2] += run.normal[2:-1].sum(axis=1) - key.get("press", 0) * ramp(t, key.get("pressing")) - key.get("gravity", 0) * m.sum()
    F -= key.get("alpha", 0) * push[1:-1] + numpy.array([0, key.get("ky", 0), key.get("kz", 0)]) * u[2:-1].sum(axis=1)
    gained = (push[3:] - push[2:-1]) / dt
    return largest(gained - (0.5 - b) * F[:-1] - (0.5 + b) * F[1:], F)


def reduced(results, limit, key):
    """A step's forces lead to its end. Half of the friction before acts in it, too, along the same slip."""
    run = Slider(results, key)
    s, length = run.slips(run.step, run.way)
    errors, T = run.laws(slice(1, len(run.t)), s, numpy.full_like(length, key["mu"]))
    heat = ((run.tangential[1:] + run.tangential[:-1]) / 2 * length * (run.normal[1:] > 0)).sum(axis=1)
    errors["heat"] = largest(run.heat - heat, heat)
    return judge(errors, limit)


def free(results, limit, densities):
    film = Film(results)
    p = (numpy.array(densities)[film.part] * film.volume)[:, None] * film.v
    relative = [film.v[i, film.part == 1].mean(axis=0) - film.v[i, film.part == 0].mean(axis=0) for i in (0, -1)]
    print(f"{len(film.v)} states, relative velocity from {relative[0]} to {relative[1]} m/s")
    if abs(relative[1] - relative[0]).max() < 0.1 * abs(relative[0]).max():
        return 1
    return judge({"momentum": abs(p.sum(axis=1) - p[0].sum(axis=0)).max() / abs(p[0]).sum()}, limit)


def recurrence(results, limit, _):
    """E = 210 GPa, 7800 kg/m^3, l = 0.1 m, A = 1e-4 m^2: k = E A / l of the element, m = rho A l / 2 of its end, pushed by 1 N."""
    table = rows(results, "transient.csv")
    t, found, dt = column(table, "time_s"), column(table, "end_x_m"), 2e-6
    k, m, u, v, exact = 210e9 * 1e-4 / 0.1, 7800 * 1e-4 * 0.1 / 2, 0.0, 0.0, {}
    push = [*ramp(numpy.arange(6) * dt, 1e-5)]
    wanted = numpy.rint(t / dt).astype(int)
    asked, last = set(wanted.tolist()), wanted[-1]
    for n in range(last + 1):
        if n in asked:
            exact[n] = u
        v += (dt if n else dt / 2) / m * ((push[n] if n < 6 else 1) - k * u)
        u += dt * v
    exact = numpy.array([exact[n] for n in wanted])
    print(f"{last} steps, {len(t)} rows")
    return judge({"displacement": largest(found - exact, exact)}, limit) if last > 999_000 else 1


def fall(results, limit, densities):
    table, film = rows(results, "transient.csv"), Film(results)
    t, normal = column(table, "time_s"), column(table, "normal_force_n")
    m, times = densities[0] * film.volume * (film.part == 1), column(rows(results, "contact_pairs.csv"), "time_s")
    at = numpy.searchsorted(t, numpy.unique(times) * (1 - 1e-12))
    gained = numpy.concatenate([[0], numpy.cumsum((normal[1:] + normal[:-1]) / 2 * numpy.diff(t))])[at] - 9.81 * m.sum() * t[at]
    print(f"impulse of contact {gained[-1] + 9.81 * m.sum() * t[at[-1]]:.3g} N s at {len(at)} times")
    return judge({"momentum": largest(film.v[:, :, 0] @ m - gained, 9.81 * m.sum() * t[at])}, limit)


COMMANDS = {"block": block, "off": off, "reduced": reduced, "free": free, "recurrence": recurrence, "fall": fall}

if __name__ == "__main__":
    command, folder, bound, words = sys.argv[1], sys.argv[2], float(sys.argv[3]), sys.argv[4:]
    keys = dict(word.split("=") for word in words if "=" in word)
    sys.exit(COMMANDS[command](folder, bound, {k: float(v) for k, v in keys.items()} if keys else [float(word) for word in words]))
