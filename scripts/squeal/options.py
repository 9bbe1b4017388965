"""The options of squeal, as the program itself tells them by -help_json: a row for each."""

import json
import subprocess
from types import SimpleNamespace

from .tables import BadInput


def ask(command, *words, folder=None):
    """What squeal, a list of words, prints when asked."""
    done = subprocess.run([*map(str, command), *words], capture_output=True, text=True, cwd=folder, check=False)
    if done.returncode:
        raise BadInput(f"{command[-1]} {' '.join(words)}: {done.stderr.strip() or f'exit status {done.returncode}'}")
    return done.stdout


def options_of(command, *words, folder=None):
    """Its options in their order, of a scene where words name one; src/quantity/json.c says the members of a row."""
    return [SimpleNamespace(**row) for row in json.loads(ask(command, *words, "-help_json", folder=folder))["options"]]


def default_of(option):
    """The default as one gives it, empty for none."""
    value = option.default
    if isinstance(value, list):
        return ",".join(f"{x:.15g}" for x in value)
    return "" if value is None else str(value).lower() if isinstance(value, bool) else f"{value:.15g}" \
        if isinstance(value, (int, float)) else value


def groups_of(options):
    """The same by the title of their group, in order."""
    found = {}
    for option in options:
        found.setdefault(option.group, []).append(option)
    return found
