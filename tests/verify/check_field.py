#!/usr/bin/env python3
"""The field of -analysis check for one contact: check_field.py RESULTS PAIRS MASTERS GAP, numbers of nodes and the gap of each pair, m."""

import sys
from pathlib import Path

import h5py


def main(folder, pairs, masters, gap):
    with h5py.File(Path(folder) / "check.h5") as file:
        found = {}
        def keep(name, item):
            if isinstance(item, h5py.Dataset):
                found[name.split("/")[-1]] = item[...].ravel()

        file.visititems(keep)
    slave, master, gaps = found["slave"], found["master"], found["gap_m"]
    of_slaves = gaps[slave == 1]
    print(f"{of_slaves.size} slaves, {(master == 1).sum()} masters, gaps {of_slaves.min():.17g} to {of_slaves.max():.17g}")
    holds = ((slave == 1).sum() == int(pairs) and not ((slave != 0) & (slave != 1)).any() and (master == 1).sum() == int(masters) and
             abs(gaps[slave == 1] - float(gap)).max() < 1e-15 and not gaps[slave == 0].any())
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
