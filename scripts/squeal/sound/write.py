"""A picture and a file to listen to, of what a microphone heard."""

import wave

import matplotlib.pyplot as plt
import numpy
from squeal.picture import BLUE, VERMILION, save_picture
from squeal.tables import header, read_table, whole

from .levels import level, main_line, shares, third_octaves, weighting, decibel

RATE = 48000  # Hz, of the file
DYNAMIC = 60  # dB that the spectrogram shows
FRAME = 4e-3  # s of it: lines 250 Hz apart
STICKING = 0.01  # of the rows


def summary(name, pressure, step):
    """Microphone, dB, dB(A), what its halves differ by, main line and its level: a row."""
    halves = [level(half, step) for half in numpy.array_split(pressure, 2)]
    frequency, size = main_line(pressure, step)
    return name, level(pressure, step, False), level(pressure, step), abs(halves[0] - halves[1]), frequency, size


def write_wave(path, pressure, step):
    """16 bit, one channel, resampled by its spectrum; what sound pressure is full scale, Pa."""
    n = int(round(len(pressure) * step * RATE))
    spectrum = numpy.fft.rfft(pressure - pressure.mean())
    kept = min(len(spectrum), n // 2 + 1)
    sound = numpy.fft.irfft(numpy.concatenate([spectrum[:kept], numpy.zeros(n // 2 + 1 - kept)]), n) * n / len(pressure)
    full = numpy.abs(sound).max() or 1
    with whole(path) as part, wave.open(str(part), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes((sound / full * 32767).astype("<i2").tobytes())
    return full


def regimes(folder, ends):
    """What the pairs of a transient do from frame to frame: rest (all that are closed stick), sticking (all do in more than 1 % of the
    rows), sliding, open (none is closed in any row); "" where transient.csv does not tell."""
    path = folder / "transient.csv"
    if not path.exists() or not {"n_closed", "n_stick"} <= set(header(path)):
        return [""] * len(ends)
    rows, found = read_table(path, {"time_s": float, "n_closed": int, "n_stick": int}), []
    for begin, end in ends:
        own = [row for row in rows if begin <= row["time_s"] < end]
        closed = [row for row in own if row["n_closed"]]
        stick = sum(row["n_stick"] == row["n_closed"] for row in closed)
        found.append("" if not own else "open" if not closed else "rest" if stick == len(own) else
                     "sticking" if stick > STICKING * len(own) else "sliding")
    return found


def draw(path, name, time, pressure, late, levels):
    """Third octaves and spectrum of the window, spectrogram of all with the level of each frame, (begin, end, dB, dB(A), ...)."""
    step = time[1] - time[0]
    figure, (bands, lines, image) = plt.subplots(3, 1, figsize=(9, 10), layout="constrained")
    rows = third_octaves(pressure[late], step)
    bands.bar(range(len(rows)), [row[2] for row in rows], color=BLUE)
    bands.set_xticks(range(len(rows)), [f"{row[0]:.3g}" if row[0] < 1000 else f"{row[0] / 1000:.3g}k" for row in rows], rotation=60)
    bands.set_ylim(bottom=max(0, max((row[2] for row in rows), default=0) - DYNAMIC))
    bands.set_title(f"{name}: {level(pressure[late], step):.1f} dB(A) from {time[late][0]:.4g} to {time[late][-1]:.4g} s")
    bands.set_xlabel("third octave, Hz")
    bands.set_ylabel("dB(A)")
    f, square = shares(pressure[late], step, True)
    heard = f <= 20000
    sizes = decibel(numpy.maximum(square * weighting(f)**2, 1e-30))[heard]
    lines.plot(f[heard] / 1000, sizes, color=VERMILION, linewidth=0.8)
    lines.set_ylim(sizes.max() - DYNAMIC, sizes.max() + 5)
    lines.set_xlabel("frequency, kHz")
    lines.set_ylabel("line, dB(A)")
    n = max(64, min(len(time) // 5, int(FRAME / step)))
    with numpy.errstate(divide="ignore"):
        power, f, t, drawn = image.specgram(pressure, NFFT=n, noverlap=3 * n // 4, Fs=1 / step, cmap="magma")
    top = 10 * numpy.log10(max(power.max(), 1e-30))
    drawn.set_clim(top - DYNAMIC, top)
    image.set_ylim(0, 20000)
    image.set_xlabel("time, s")
    image.set_ylabel("frequency, Hz")
    figure.colorbar(drawn, ax=image, label="dB to 1 Pa^2/Hz", pad=0.1)
    loud = image.twinx()
    loud.stairs([max(row[3], -DYNAMIC) for row in levels], [levels[0][0], *(row[1] for row in levels)], baseline=None, color="white")
    loud.set_ylabel("level of frames (white), dB(A)")
    save_picture(figure, path, 120)
