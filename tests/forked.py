"""Runs a Python script of this repository in a child of this process. Modules that are imported here are not imported
again, which is most of what a short script costs."""

import os
import runpy
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path


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
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        sys.stdout.flush()
        sys.stderr.flush()
        child = os.fork()
        if not child:
            os._exit(_be(Path(script), words, folder, out, err))
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        for file in (out, err):
            file.seek(0)
        return subprocess.CompletedProcess([str(script), *words], status, out.read(), err.read())


def run_well(script, *words):
    """What a script says, which must succeed."""
    done = run_script(script, words)
    if done.returncode:
        raise SystemExit(f"{script} {' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


def _be(script, words, folder, out, err):
    """Exit status of the script, which this process becomes."""
    try:
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.dup2(out.fileno(), 1)
        os.dup2(err.fileno(), 2)
        if folder:
            os.chdir(folder)
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
        sys.stdout.flush()
        sys.stderr.flush()
