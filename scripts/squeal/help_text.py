"""What `squeal -help` prints, taken apart; the manual page and tests are made of it."""

import re
import subprocess
from dataclasses import dataclass

from .tables import BadInput

NAME_WIDTH = 32  # columns of a line of -help up to the default


@dataclass(frozen=True)
class Option:
    """Name without dash, default, and text of an option, in the group of its owner."""
    group: str
    name: str
    default: str
    text: str


def ask(command, *words, folder=None):
    """What squeal, a list of words, prints when asked."""
    done = subprocess.run([*map(str, command), *words], capture_output=True, text=True, cwd=folder, check=False)
    if done.returncode:
        raise BadInput(f"{command[-1]} {' '.join(words)}: {done.stderr.strip() or f'exit status {done.returncode}'}")
    return done.stdout


def options_of(text):
    """The options, in their order."""
    found, group = [], ""
    for line in text.splitlines():
        match = re.match(r"  -(\w+)", line)
        if match:
            rest = line[max(NAME_WIDTH, match.end() + 1):]
            default, meaning = ("", rest) if not rest[:14].strip() else rest.split(" ", 1)
            found.append(Option(group, match[1], default, meaning.strip()))
        elif line and line[0] != " ":
            group = line
    if not found:
        raise BadInput("squeal -help: lists no options")
    return found
