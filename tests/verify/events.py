#!/usr/bin/env python3
"""A code of its own for few masses with dry friction, driven by events, and forced friction oscillators beside it.

    M x'' + C x' + K x = f(t) - R,   f(t) = sum P cos(w t + phi),   R_i = mu_i N_i sign(x_i' - v_i) while mass i slides,
    |R_i| <= s_i N_i while it sticks, x_i' = v_i (belts with constant speeds v, s the static coefficient)

Between events the system is linear; with the state z = (x, v, cos w t, sin w t, 1) it is z' = A z, and exp(A t) gives it without error of
a step. Events (a mass stops; one that sticks reaches its limit) are bracketed on a fine grid, exp(A h) each, and found by Brent's method.

    events.py closed                  the code beside Den Hartog's closed solution: amplitude and phase
    events.py start CASE              options of squeal's scene that begins on the motion to which all others come, at x = 0
    events.py beside CASE FOLDER      transient.csv of that scene: amplitude to 1e-4, motion, stops per cycle; TOLERANCES says which

J. P. Den Hartog, Trans. ASME 53 (1931) APM-107: with V = 1 / (1 - r^2), r = w / w_0, U = sin(pi/r) / (r (1 + cos(pi/r))) the largest
displacement of motions without a stop is  x_0 = sqrt((P V / k)^2 - (F U / k)^2),  x_0 = (P V / k) cos phi,  (P V / k) sin phi = -F U / k,
phi the phase of the force at x_0. H.-K. Hong, C.-S. Liu, J. Sound Vib. 229 (2000) 1171 and 244 (2001) 883: below it the motion has
2, 4, 6, ... stops in a cycle, the more the lower the frequency."""

import argparse
import csv
import math
from pathlib import Path

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

SLIDES_BACK = 1e-12  # of the limit, beyond which a mass that stops moves on
PER_PERIOD = 400     # places at which events are looked for, of the shortest period
SETTLED = 40         # cycles after which a motion repeats itself to 1e-8
WATCHED = 2          # cycles of squeal
REST = 3e-3          # of the largest velocity: below it, for a two hundredth of a cycle, a mass is at rest
P, K = 40.0, 1e4     # N, N/m; masses of 1 kg
LINK = 5e3           # N/m between two masses
# name: Hz, friction (N) of each mass, stops per cycle of the first as this code counts them
CASES = {"none": (12.0, [10.0], 0), "two": (5.0, [10.0], 2), "four": (2.0, [10.0], 4), "six": (1.2, [8.0], 6),
         "pair": (14.0, [10.0, 6.0], 0)}
TOLERANCES = {"amplitude": 1e-4, "phase": 1e-4, "motion": 5e-4}


class Masses:
    """Matrices, limits of friction [n] sliding and at rest (N), speeds of belts, and harmonic forces [(amplitudes [n], rad/s, phase)]."""

    def __init__(self, M, K, slides, rests=None, C=None, speed=None, forces=()):
        self.M, self.K = np.atleast_2d(M).astype(float), np.atleast_2d(K).astype(float)
        self.n = n = len(self.M)
        self.slides = np.array(slides, float)
        self.rests = self.slides if rests is None else np.array(rests, float)
        self.C = np.zeros((n, n)) if C is None else np.atleast_2d(C)
        self.speed = np.zeros(n) if speed is None else np.array(speed, float)
        self.forces = [(np.array(a, float), w, p) for a, w, p in forces]
        fastest = math.sqrt(max(np.linalg.eigvals(np.linalg.solve(self.M, self.K)).real.max(), 1e-300))
        self.h = 2 * math.pi / max([fastest] + [w for _, w, _ in self.forces]) / PER_PERIOD
        self.kept = {}

    def start(self, x, v):
        return np.concatenate([x, v, *[(math.cos(p), math.sin(p)) for _, _, p in self.forces], [1.0]])

    def rate(self, sign):
        """A and the grid's exp(A h): masses slide with the sign of x' - v, and stick where it is 0."""
        key = tuple(sign)
        if key in self.kept:
            return self.kept[key]
        n, size = self.n, 2 * self.n + 2 * len(self.forces) + 1
        A, force = np.zeros((size, size)), np.zeros((n, size))
        force[:, :n], force[:, n:2 * n], force[:, -1] = -self.K, -self.C, -np.array(sign) * self.slides
        for i, (a, w, _) in enumerate(self.forces):
            at = 2 * n + 2 * i
            force[:, at] += a
            A[at, at + 1], A[at + 1, at] = -w, w
        free = np.flatnonzero(sign)
        A[:n, n:2 * n] = np.eye(n)
        A[n + free] = np.linalg.solve(self.M[np.ix_(free, free)], force[free])
        # what friction holds of a mass that sticks: the sum of all else on it, accelerations of the others included
        held = force - self.M @ A[n:2 * n]
        self.kept[key] = A, expm(A * self.h), held
        return self.kept[key]

    def next_sign(self, z, sign):
        """Signs after an event: each mass at the belt's speed sticks if friction can hold it, else goes where it is pulled."""
        sign = list(sign)
        for i in range(self.n):
            if sign[i] == 0:
                pull = self.rate(sign)[2][i] @ z
                if abs(pull) > self.rests[i] * (1 + SLIDES_BACK):
                    sign[i] = int(math.copysign(1, pull))
        return sign

    def run(self, x, v, end):
        """Pieces (t, z, A, exp(A h), sign) and events (t, mass, sign after) from t = 0 on."""
        n, t, z = self.n, 0.0, self.start(x, v)
        sign = [int(np.sign(z[n + i] - self.speed[i])) for i in range(n)]
        sign = self.next_sign(z, sign)
        pieces, events = [], []
        while t < end:
            A, step, held = self.rate(sign)

            def watch(z):
                """Positive while the state goes on."""
                return np.array([sign[i] * (z[n + i] - self.speed[i]) if sign[i] else self.rests[i] - abs(held[i] @ z) for i in range(n)])

            pieces.append((t, z, A, list(sign)))
            since, now, was = 0.0, z, np.maximum(watch(z), 0)
            while t + since < end:
                later = step @ now
                is_ = watch(later)
                crossed = np.flatnonzero(is_ < 0)
                if len(crossed):
                    break
                since, now, was = since + self.h, later, is_
            else:
                break
            found = []
            for i in crossed:
                def one(s, i=i, now=now):
                    return watch(expm(A * s) @ now)[i]
                begin = one(1e-9 * self.h)
                found.append((brentq(one, 1e-9 * self.h, self.h, xtol=1e-15) if begin > 0 else 0.0, i))
            s, i = min(found)
            z = expm(A * s) @ now
            t += since + s
            if sign[i]:
                z[n + i], sign[i] = self.speed[i], 0
                sign = self.next_sign(z, sign)
            else:
                sign[i] = int(math.copysign(1, held[i] @ z))
            events.append((t, i, sign[i]))
        self.pieces, self.events = pieces, events
        return self

    def at(self, times):
        """States at the times, [len][2 n]."""
        begins = np.array([p[0] for p in self.pieces])
        out = np.empty((len(times), 2 * self.n))
        for k, t in enumerate(times):
            begin, z, A, _ = self.pieces[np.searchsorted(begins, t, side="right") - 1]
            out[k] = (expm(A * (t - begin)) @ z)[:2 * self.n]
        return out

    def stops(self, begin, period, mass=0):
        """How often a mass comes to rest and stays for a while in a cycle."""
        return sum(1 for t, i, s in self.events if i == mass and s == 0 and begin <= t < begin + period)

    def peak(self, begin, period):
        """The largest displacement of mass 0 in a cycle and its time, by the velocity's zero."""
        times = begin + np.linspace(0, period, 2001)
        x = self.at(times)
        k = int(np.argmax(x[:, 0]))
        low, high = times[max(k - 1, 0)], times[min(k + 1, 2000)]
        value = [self.at([t])[0, self.n] for t in (low, high)]
        t = brentq(lambda t: self.at([t])[0, self.n], low, high, xtol=1e-14) if value[0] > 0 > value[1] else times[k]
        return self.at([t])[0, 0], t


def den_hartog(P, F, w, k=1e4, m=1.0):
    """Largest displacement and the phase of the force there, of motions without a stop."""
    r = w / math.sqrt(k / m)
    V, U = 1 / (1 - r * r), math.sin(math.pi / r) / (r * (1 + math.cos(math.pi / r)))
    x = math.sqrt((P * V / k) ** 2 - (F * U / k) ** 2)
    return x, math.atan2(-(F * U) / (P * V), x * k / (P * V))


def angle(a):
    return (a + math.pi) % (2 * math.pi) - math.pi


def masses(case):
    """The system of a case, run from rest until it repeats itself; of two masses for some cycles."""
    hertz, friction, _ = CASES[case]
    n = len(friction)
    K_all = K * np.eye(n) + (LINK * np.array([[1, -1], [-1, 1]]) if n == 2 else 0)
    system = Masses(np.eye(n), K_all, friction, forces=[([P] + [0.0] * (n - 1), 2 * math.pi * hertz, 0.0)])
    return system.run(np.zeros(n), np.zeros(n), ((SETTLED if n == 1 else 0) + WATCHED + 2) / hertz)


def begin(system, hertz):
    """When mass 0 goes up through 0 after it has settled, and the state there."""
    times = (SETTLED + np.linspace(0, 1, 2001)) / hertz
    x = system.at(times)[:, 0]
    j = np.flatnonzero((x[:-1] <= 0) & (x[1:] > 0))[0]
    t = brentq(lambda t: system.at([t])[0, 0], times[j], times[j + 1], xtol=1e-15)
    return t, system.at([t])[0]


def start(case):
    """Options of the scene of one mass. Two begin at rest: their motion is compared from there on."""
    hertz = CASES[case][0]
    t, state = begin(masses(case), hertz)
    phase = math.degrees(angle(2 * math.pi * hertz * t))
    print(f"-shake_frequency {hertz!r} -shake_phase {phase!r} -block_velocity 0,{state[1]!r},0")


def count_rests(t, v, period):
    """How often a motion rests in a cycle."""
    still, n, since = abs(v) < REST * abs(v).max(), 0, None
    for i, rests in enumerate(still):
        if not rests:
            since = None
        elif since is None:
            since = i
        elif since >= 0 and t[i] - t[since] > period / 200:
            n, since = n + 1, -1
    return n


def beside(case, folder):
    """Motion, amplitude, phase of the zero before the peak, and stops in the last cycle."""
    hertz, friction, stops = CASES[case]
    period, w = 1 / hertz, 2 * math.pi * hertz
    with (folder / "transient.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    t, y, v = (np.array([float(row[name]) for row in rows]) for name in ("time_s", "tip_y_m", "tip_vy_m_s"))
    system = masses(case)
    since = begin(system, hertz)[0] if len(friction) == 1 else 0.0
    ref = system.at(since + t)
    last = t >= (WATCHED - 1) * period
    top = system.peak(since + (WATCHED - 1) * period, period)[0]
    found = {"amplitude": y[last].max() / ref[last, 0].max() - 1, "motion": abs(y - ref[:, 0]).max() / top}
    # the last way up through 0: what the phase of the force is then, beside the code's
    i = [j for j in range(len(y) - 1) if y[j] <= 0 < y[j + 1]][-1]
    now = brentq(lambda s: np.interp(s, t[i:i + 2], y[i:i + 2]), t[i], t[i + 1])
    then = brentq(lambda s: system.at([since + s])[0, 0], t[i] - 0.01 * period, t[i + 1] + 0.01 * period, xtol=1e-15)
    found["phase"] = w * (now - then)
    counted = count_rests(t[last], v[last], period)
    print(f"{case}: {hertz:g} Hz, friction {', '.join(f'{f:g}' for f in friction)} N: x_0 {top:.9g} m, {counted} stops of {stops};",
          ", ".join(f"{name} {value:.2e} of {TOLERANCES[name]:g}" for name, value in found.items()))
    return counted == stops and all(abs(value) <= TOLERANCES[name] for name, value in found.items())


def closed():
    """The code itself: Den Hartog's amplitude and phase to 1e-9."""
    good = True
    for hertz, F in ((12.0, 10.0), (20.0, 24.0), (30.0, 20.0)):
        w = 2 * math.pi * hertz
        system = Masses([1.0], [K], [F], forces=[([P], w, 0.0)]).run([0.0], [0.0], 82 / hertz)
        x, t = system.peak(80 / hertz, 1 / hertz)
        x_0, phi = den_hartog(P, F, w)
        off = abs(x / x_0 - 1), abs(angle(w * t - phi))
        print(f"{hertz:g} Hz, friction {F:g} N: amplitude off by {off[0]:.1e}, phase by {off[1]:.1e} rad")
        good = good and max(off) < 1e-9
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["closed", "start", "beside"])
    parser.add_argument("case", nargs="?", choices=list(CASES))
    parser.add_argument("folder", nargs="?", type=Path)
    args = parser.parse_args()
    if args.what == "start":
        start(args.case)
    elif not (closed() if args.what == "closed" else beside(args.case, args.folder)):
        raise SystemExit(1)


if __name__ == "__main__":
    main()
