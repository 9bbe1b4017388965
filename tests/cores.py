"""Kernels that OpenBLAS has for several processors, by which results are rounded differently; another BLAS takes no notice."""

import os
from pathlib import Path

CORES = {"Nehalem": "sse4_2", "Haswell": "avx2", "Zen": "avx2", "SkylakeX": "avx512vl"}  # and an instruction that each needs
MIXED = "mixed"
BY_RANK = "Haswell", "Nehalem", "Zen"


def choose_core(core):
    """Has OpenBLAS take the kernels of a processor; of mixed ones each rank chooses when it starts. Says why that cannot be,
    where this processor would not run them."""
    try:
        flags = Path("/proc/cpuinfo").read_text().split()
    except OSError:
        flags = []
    if core != MIXED:
        os.environ["OPENBLAS_CORETYPE"] = core
    lacking = [(name, CORES[name]) for name in (BY_RANK if core == MIXED else (core,)) if CORES[name] not in flags]
    return f"no {lacking[0][1]} here, which the kernels for {lacking[0][0]} need" if lacking else None


def mixed(program):
    """How each rank starts a program, with the kernels for another processor than the rank before."""
    choice = f"cores=({' '.join(BY_RANK)}); export OPENBLAS_CORETYPE=${{cores[OMPI_COMM_WORLD_RANK % {len(BY_RANK)}]}}"
    return ["bash", "-c", f'{choice}; exec "$0" "$@"', program]
