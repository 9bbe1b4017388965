"""Histogram of effectivities."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

LEAST, MOST = 1e-4, 10


def draw_histogram(path, ratios):
    """One panel for each name, true error over stated error; what exceeds one is red."""
    edges = numpy.logspace(numpy.log10(LEAST), numpy.log10(MOST), 51)
    figure, axes = plt.subplots(1, len(ratios), figsize=(9, 3.2), layout="constrained")
    for axis, (name, ratio) in zip(axes, ratios.items()):
        ratio = numpy.clip(ratio, LEAST, MOST)
        axis.hist(ratio[ratio <= 1], edges, color="tab:blue")
        axis.hist(ratio[ratio > 1], edges, color="tab:red")
        axis.axvline(1, color="black", linewidth=0.8)
        axis.set_xscale("log")
        axis.set_xlabel("true error / stated error")
        axis.set_ylabel("eigenvalues")
        axis.set_title(f"{name}: {ratio.size} eigenvalues, {(ratio <= 1).mean():.2%} within", fontsize=10)
    figure.savefig(path, dpi=100)
    plt.close(figure)
