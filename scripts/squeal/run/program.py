"""squeal as the studies and benchmarks run it: compiled where it is not, each run checked, parts chosen by --part."""

import argparse
import contextlib
import os
import shlex
import subprocess
import sys
from pathlib import Path

from .. import STOPPED
from ..tables import BadInput

ROOT = Path(__file__).resolve().parents[3]


def called(script):
    """What one types for a script of scripts/: its path in a checkout, or its name where it is installed."""
    if (ROOT / "meson.build").is_file():
        return f"scripts/{script}"
    folder, _, name = script.rpartition("/")
    return "-".join(filter(None, ("squeal", folder if folder == "plot" else "", name.replace("_", "-"))))


def prepared(functions):
    """Path of the program of a checkout after functions of setup.sh, and sets the kernels of OpenBLAS that these choose."""
    command = ["bash", "-c", f'source "$0" && {functions} >&2 && echo "$build/squeal" && echo "${{OPENBLAS_CORETYPE-}}"',
               ROOT / "scripts/setup.sh"]
    process = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if process.returncode:
        raise SystemExit(process.returncode)
    program, kernels = process.stdout.splitlines()
    if kernels:
        os.environ["OPENBLAS_CORETYPE"] = kernels
    return Path(program)


def chosen_program(path, said="--program"):
    """The program that an option gives; else the one that is compiled as scripts/run does, or installed with this script. It has the
    kernels of OpenBLAS that scripts/run chooses."""
    if path and not (path.is_file() and os.access(path, os.X_OK)):
        raise SystemExit(f"{said} {path}: {'is no program' if path.exists() else 'no such file'}; needed is squeal")
    if not (ROOT / "meson.build").is_file():
        return (path or ROOT.parents[1] / "bin/squeal").resolve()
    found = prepared(f"check_blas {shlex.quote(str(path))}" if path else "set_up squeal")
    return (path or found).resolve()


def scene(*names, before=None):
    """Words of the options files of options/, named without their ending, in their order; of the folder `before` where it has them."""
    own = ROOT / "options"
    files = [(before if before and (before / f"{name}.yaml").is_file() else own) / f"{name}.yaml" for name in names]
    return [word for file in files for word in ("-options_file", file)]


def launch(program, ranks, words, about):
    """What squeal prints. A run that fails ends the script with its message, after what it is `about`."""
    command = [ROOT / "scripts/mpirun", "-n", ranks, program, *words]
    process = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if process.returncode:
        raise SystemExit(f"{about}: {process.stderr.strip()}")
    return process.stdout


def measured(command, about, may_fail=lambda text: False, folder=None):
    """What a command prints, s of processor and MB at most of its processes. A failure is bad input, unless it may fail
    with such a text."""
    command = [str(word) for word in command]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder) as process:
        text = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode and not may_fail(text):
        errors = [line.strip() for line in text.splitlines() if "error" in line.lower()]
        raise BadInput(f"{about}: {errors[-1] if errors else text.strip()[-300:]}")
    return text, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def measured_run(program, ranks, words, about):
    """The same of a run of squeal."""
    return measured([ROOT / "scripts/mpirun", "-n", ranks, program, *words], about)


def parts_parser(doc, parts):
    """Command line with --part, where there are parts, and --program."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    if parts:
        parser.add_argument("--part", action="append", choices=parts, help="only this one; may be repeated")
    parser.add_argument("--program", type=Path, metavar="FILE", help="squeal; default: compiled as by scripts/run")
    return parser


def parse(parser, **least):
    """The command line; numbers have a least value."""
    args = parser.parse_args()
    for name, low in least.items():
        if getattr(args, name) < low:
            parser.error(f"--{name.replace('_', '-')} {getattr(args, name)}: must be {low} or more")
    args.program = chosen_program(args.program)
    return args


def machine_text():
    """Cores, and how busy they are."""
    return f"machine: {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"


@contextlib.contextmanager
def one_line(name):
    """Bad input ends the script `name` with one line, and so does ^C."""
    try:
        yield
    except BadInput as error:
        raise SystemExit(f"{name}: {error}") from None
    except KeyboardInterrupt:
        print(f"{name}: stopped", file=sys.stderr)
        raise SystemExit(STOPPED) from None


def do_parts(name, parts, chosen, *given):
    """The chosen parts, or all, each with what is given."""
    for part in chosen or parts:
        with one_line(name):
            parts[part](*given)
        sys.stdout.flush()


def met(kept):
    """The word for it."""
    return "met" if kept else "MISSED"


def print_demand(what, value, limit, form, least=False):
    """One line: value, limit, and whether it is kept."""
    kept = value >= limit if least else value <= limit
    print(f"  {what} {value:{form}}, demanded {limit:{form}} at {'least' if least else 'most'}: {met(kept)}")
