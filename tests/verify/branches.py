#!/usr/bin/env python3
"""Branches and onsets of a sweep beside those of a finer or another one: verify/branches.py SWEEP REFERENCE BROKEN ONSETS

At values that both have, modes are the same by their eigenvalues. Each branch of SWEEP must lie in one of
REFERENCE, whatever their numbers; BROKEN more of them than there are modes mean that as many ended and began anew. Which of two
branches takes the unstable member of a pair is a matter of names: there both must be in the same two. Each of the ONSETS of SWEEP
must be an onset of REFERENCE, of the same kind and of the same branches, within its error."""

import collections
import csv
import sys
from pathlib import Path

SAME = 1e-5  # of an eigenvalue, relative


def table(folder, name):
    """Rows of a table."""
    with (Path(folder) / name).open(newline="") as file:
        return list(csv.DictReader(file))


def points(folder):
    """Modes of each point: eigenvalue over 2 pi, branch."""
    modes = collections.defaultdict(list)
    for row in table(folder, "sweep.csv"):
        eigenvalue = complex(float(row["growth_rad_s"]) / 6.283185307179586, float(row["freq_hz"]))
        modes[float(row["value"]), row["value_2"]].append((eigenvalue, row["branch"]))
    return modes


def partners(ours, theirs):
    """Our modes of a point with those of the reference, one to one."""
    left = list(theirs)
    for eigenvalue, branch in ours:
        other = min(left, key=lambda mode: abs(mode[0] - eigenvalue))
        if abs(other[0] - eigenvalue) > SAME * abs(eigenvalue):
            raise SystemExit(f"{eigenvalue} has no partner, the nearest is {other[0]}")
        left.remove(other)
        yield eigenvalue, branch, other[1]
    if left:
        raise SystemExit(f"{len(left)} modes of the reference have no partner")


def in_pairs(pairs):
    """The same with both members of a lock-in pair as one."""
    groups = collections.defaultdict(list)
    for eigenvalue, ours, theirs in pairs:
        groups[f"{eigenvalue.imag:.7g} {abs(eigenvalue.real):.4g}" if eigenvalue.real else len(groups)].append((ours, theirs))
    for group in groups.values():
        yield frozenset(ours for ours, _ in group), frozenset(theirs for _, theirs in group)


def branches(sweep, reference):
    """The branches of the reference in which each of ours may lie."""
    where = {}
    both = sweep.keys() & reference.keys()
    for point in sorted(both):
        for ours, theirs in in_pairs(partners(sweep[point], reference[point])):
            for branch in ours:
                left = where.get(branch, theirs) & theirs
                if not left:
                    raise SystemExit(f"branch {branch} goes from {where[branch]} of the reference to {theirs} at {point}")
                where[branch] = left
    print(f"{len(both)} points, {len(where)} branches in {len(set().union(*where.values()))} of the reference")
    return where


def check_onset(onset, known, where):
    """Whether the reference has an onset."""
    own = set().union(*(where.get(onset[key], ()) for key in ("branch", "partner")))
    value, error = float(onset["critical_value"]), float(onset["error_estimate"])
    near = [abs(float(row["critical_value"]) - value) for row in known
            if row["kind"] == onset["kind"] and row["value_2"] == onset["value_2"] and own & {row["branch"], row["partner"]}]
    print(f"{onset['kind']} at {value:.6g} +- {error:.2g}: the reference is {min(near, default=float('nan')):.2g} away")
    if not near or min(near) > error or onset["confirmed"] != "0":
        raise SystemExit("no such onset in the reference")


ours, theirs, broken, count = *sys.argv[1:3], *map(int, sys.argv[3:])
in_branch = branches(points(ours), points(theirs))
if len(in_branch) - len(set().union(*in_branch.values())) != broken:
    raise SystemExit(f"{broken} branches must be broken")
found = table(ours, "onsets.csv")
for one in found:
    check_onset(one, table(theirs, "onsets.csv"), in_branch)
if len(found) != count:
    raise SystemExit(f"{len(found)} onsets, must be {count}")
