"""Processes of the machine, of which any may end while they are looked at."""

from pathlib import Path


def processes(what):
    """Number of each process, and its /proc/NUMBER/`what`: "cmdline" has its words, each ended by a null byte."""
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                content = (folder / what).read_bytes()
            except OSError:
                continue  # ended
            yield int(folder.name), content


def processes_naming(text):
    """Those whose command line holds `text`."""
    return [number for number, line in processes("cmdline") if str(text).encode() in line]
