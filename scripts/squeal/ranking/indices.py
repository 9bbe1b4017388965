"""Which of several unstable modes wins: indices that rank them, how often each is right, and how sure that is. Pure
functions, used by study/ranking."""

import math
from typing import NamedTuple

SAME = 0.05  # a main line farther than this from a mode, relative, is not that mode's
SURE = 0.95  # of the intervals


class Candidate(NamedTuple):
    """An unstable mode: number, label, Hz, 1/s, damping ratio, stated error of its frequency (Hz), growth about other
    states by name (1/s), width of the unstable interval by parameter, velocity at the probe just after the blow (m/s),
    sliding speed (m/s)."""
    mode: int
    label: str
    freq: float
    growth: float
    damping: float
    error: float
    elsewhere: dict
    width: dict
    start: float
    speed: float


class Outcome(NamedTuple):
    """The end of a run: main line (Hz), that of as long a time before, velocity at the probe by mode (m/s)."""
    line: float
    before: float
    shares: dict


def time_to_speed(c):
    """When a mode alone would reach the sliding speed at the probe, s: ln(v / v_0) / sigma."""
    return math.log(c.speed / c.start) / c.growth


def overtakes(a, b):
    """Time after the blow at which b becomes as large as a at the probe, s: ln(a_0 / b_0) / (sigma_b - sigma_a); 0
    where it is from the start, infinite where it never does."""
    if b.start >= a.start:
        return 0.0
    return math.log(a.start / b.start) / (b.growth - a.growth) if b.growth > a.growth else math.inf


INDICES = {
    "growth": lambda c: c.growth,
    "damping ratio, the most negative": lambda c: -c.damping,
    "first to reach the sliding speed": lambda c: -time_to_speed(c),
    "width over mu": lambda c: c.width["contact_mu"],
    "width over the pad's modulus": lambda c: c.width["pad_young"],
    "growth over its error": lambda c: c.growth / c.error,
    "growth, a row of pairs less": lambda c: c.elsewhere["less"],
    "growth, all pairs closed": lambda c: c.elsewhere["all"],
    "lowest frequency": lambda c: -c.freq,
}


def winner(candidates, line):
    """Unstable mode nearest to a main line, by the ratio of frequencies; None where none is near."""
    best = min(candidates, key=lambda c: abs(math.log(line / c.freq)))
    return best.mode if abs(line / best.freq - 1) <= SAME else None


def largest_share(outcome):
    """Mode that moves the probe most."""
    return max(outcome.shares, key=outcome.shares.get)


def predicted(candidates, index):
    """Mode that an index puts first."""
    return max(candidates, key=INDICES[index]).mode


def tail(k, n, p):
    """Probability of k or more of n."""
    return sum(math.comb(n, i) * p**i * (1 - p)**(n - i) for i in range(k, n + 1))


def root(beyond, low=0.0, high=1.0):
    """Least place from which a condition holds, by halving."""
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if beyond(middle) else (middle, high)
    return (low + high) / 2


def interval(k, n, sure=SURE):
    """Confidence interval of a share of which k of n were seen: it holds the true one with this probability at least.
    Reference: Clopper and Pearson, Biometrika 26, 1934."""
    alpha = (1 - sure) / 2
    low = 0.0 if k == 0 else root(lambda p: tail(k, n, p) >= alpha)
    high = 1.0 if k == n else root(lambda p: 1 - tail(k + 1, n, p) <= alpha)
    return low, high


def by_chance(counts):
    """Probabilities of 0, 1, ... right guesses at scenes of so many candidates each."""
    law = [1.0]
    for count in counts:
        law = [(law[k] if k < len(law) else 0.0) * (1 - 1 / count) + (law[k - 1] / count if k else 0.0)
               for k in range(len(law) + 1)]
    return law


class Score(NamedTuple):
    """Of an index: right in so many scenes of so many, interval of that share, probability that guesses do as well."""
    index: str
    right: int
    of: int
    interval: tuple
    chance: float


def scores(scenes, winners):
    """Of every index, the best first. `scenes`: lists of candidates; `winners`: the mode of each, None where it is none
    of them, for which every index is wrong."""
    law = by_chance([len(candidates) for candidates in scenes])
    rows = []
    for index in INDICES:
        right = sum(predicted(candidates, index) == mode for candidates, mode in zip(scenes, winners))
        rows.append(Score(index, right, len(scenes), interval(right, len(scenes)), sum(law[right:])))
    return sorted(rows, key=lambda row: -row.right)
