"""What the scripts share: tables and their errors, runs of squeal, signals, pictures. Each module
says what it holds."""

import os
import signal
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
OWN = tuple(os.path.join(ROOT, folder, "") for folder in ("scripts", "tests"))
STOPPED = 130  # exit status after ^C, as of a shell


def say_stopped():
    """The line of ^C where the script does not say more."""
    print(f"{os.path.basename(sys.argv[0])}: stopped", file=sys.stderr, flush=True)


def interrupt(number, frame):
    """^C while a module is read ends the script at once, since numpy makes another error of it; else as ever."""
    while frame:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            say_stopped()
            os._exit(STOPPED)
        frame = frame.f_back
    raise KeyboardInterrupt


def end_uncaught(kind, error, trace):
    """^C that the script itself does not look for, as before its work: one line."""
    if issubclass(kind, KeyboardInterrupt):
        say_stopped()
        sys.exit(STOPPED)
    sys.__excepthook__(kind, error, trace)


if os.path.isfile(sys.argv[0]) and os.path.realpath(sys.argv[0]).startswith(OWN):  # programs of others keep what they have
    # Before numpy and matplotlib are read: one BLAS thread, as squeal itself has it; pictures go to files, not to a screen
    os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"
    os.environ["MPLBACKEND"] = "Agg"
    sys.excepthook = end_uncaught
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # not where nohup or & ignores it
        signal.signal(signal.SIGINT, interrupt)
