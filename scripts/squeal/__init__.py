"""What the scripts share: tables and their errors, runs of squeal, signals, pictures. Each module
says what it holds."""

import os

# Before numpy and matplotlib are read: one BLAS thread, as squeal itself has it; pictures go to files, not to a screen
os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"
os.environ["MPLBACKEND"] = "Agg"
