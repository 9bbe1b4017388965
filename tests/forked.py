"""Runs a Python script of this repository in a child of this process. Modules that are imported here are not imported
again, which is most of what a short script costs: what a child imports of installed packages is imported here after it,
for the next one."""

import contextlib
import importlib
import os
import runpy
import subprocess
import sys
import sysconfig
import tempfile
import traceback
from pathlib import Path

PACKAGES = tuple({sysconfig.get_paths()["stdlib"], "/usr/lib/python3/dist-packages", *(path for path in sys.path if "-packages" in path)})
REPOSITORY = Path(__file__).resolve().parents[1]
ALONE = ("mpi4py", "petsc4py", "slepc4py")  # begin MPI as they are imported


def run_command(words, folder=None):
    """What subprocess.run() returns of a command in a working folder; Python scripts run in children."""
    words = [str(word) for word in words]
    path = Path(words[0])
    if path.is_file() and path.open("rb").readline().rstrip().endswith(b"python3"):
        return run_script(path, words[1:], folder)
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)


def run_script(script, words=(), folder=None):
    """What subprocess.run() returns of a script with arguments `words` in a working folder."""
    words = [str(word) for word in words]
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err, tempfile.TemporaryFile("w+") as read:
        sys.stdout.flush()
        sys.stderr.flush()
        child = os.fork()
        if not child:
            os._exit(_be(Path(script), words, folder, out, err, read))
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        for file in (out, err, read):
            file.seek(0)
        for name in read.read().split():
            with contextlib.suppress(Exception):
                importlib.import_module(name)
        return subprocess.CompletedProcess([str(script), *words], status, out.read(), err.read())


def run_well(script, *words):
    """What a script says, which must succeed."""
    done = run_script(script, words)
    if done.returncode:
        raise SystemExit(f"{script} {' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


def _be(script, words, folder, out, err, read):
    """Exit status of the script, which this process becomes; names of modules that it imports, for its parent."""
    before = set(sys.modules)
    try:
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.dup2(out.fileno(), 1)
        os.dup2(err.fileno(), 2)
        if folder:
            os.chdir(folder)
        if not script.resolve().is_relative_to(REPOSITORY):  # it has its own package of this name
            for name in [name for name in sys.modules if name.partition(".")[0] == "squeal"]:
                del sys.modules[name]
        sys.argv = [str(script), *words]
        sys.path[0] = str(script.parent)
        runpy.run_path(str(script), run_name="__main__")
        return 0
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
        return 1
    finally:
        new = {name: getattr(module, "__file__", None) or "" for name, module in sys.modules.items() if name not in before}
        print(*(name for name, file in new.items() if file.startswith(PACKAGES) and not name.startswith(ALONE)), file=read, flush=True)
        sys.stdout.flush()
        sys.stderr.flush()
