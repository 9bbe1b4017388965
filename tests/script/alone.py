#!/usr/bin/env python3
"""Scripts alone: each answers --help in an interpreter of its own, and no file of scripts/ names a module inside a package that it does
not import, as scipy.linalg by `import scipy`: that passes where something else has imported the module, as tests/forked.py does.

    alone.py"""

import ast
import importlib.util
import subprocess
import sys
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def python_files():
    """Python files of scripts/, first those that are run."""
    files = [path for path in sorted(SCRIPTS.rglob("*")) if path.is_file() and "__pycache__" not in path.parts]
    run = [path for path in files if path.open("rb").readline().rstrip().endswith(b"python3")]
    return run, run + [path for path in files if path.suffix == ".py" and path not in run]


def is_module(name):
    """Whether a module of that name could be imported; packages begin nothing as they are imported here."""
    try:
        return importlib.util.find_spec(name) is not None
    except (ImportError, ValueError):
        return False


def dotted(node):
    """a.b.c of an attribute of a name, or nothing."""
    words = []
    while isinstance(node, ast.Attribute):
        words.append(node.attr)
        node = node.value
    return ".".join([node.id, *reversed(words)]) if isinstance(node, ast.Name) and words else None


def imports_of(tree):
    """Names of packages by the names that they have in a file, and all modules that the file imports."""
    names, modules = {}, set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            modules |= {each.name for each in node.names}
            for each in node.names:
                package = each.name.split(".", maxsplit=1)[0]
                names[each.asname or package] = each.name if each.asname else package
        elif isinstance(node, ast.ImportFrom) and not node.level:
            modules |= {node.module} | {f"{node.module}.{each.name}" for each in node.names}
            names.update({each.asname or each.name: f"{node.module}.{each.name}" for each in node.names})
    return names, modules


def missing(text):
    """Modules that a file uses of packages, which neither it nor the package itself imports."""
    tree, found = ast.parse(text), set()
    names, modules = imports_of(tree)
    for chain in filter(None, map(dotted, ast.walk(tree))):
        first, *rest = chain.split(".")
        for k in range(len(rest) if first in names else 0):
            name = ".".join([names[first], *rest[:k + 1]])
            if not is_module(name):
                break
            if not any(each == name or each.startswith(name + ".") for each in modules):
                found.add(name)
    return found


def not_with_package(name):
    """Whether a module is absent where only its package is imported, in an interpreter of its own."""
    package = name.split(".", maxsplit=1)[0]
    return subprocess.run([sys.executable, "-c", f"import sys, {package}; sys.exit({name!r} not in sys.modules)"], check=False).returncode


def main():
    faults = [] if missing("import scipy\nscipy.linalg.eig(0)") == {"scipy.linalg"} else ["scipy.linalg of `import scipy` is not seen"]
    run, files = python_files()
    for path in files:
        faults += [f"{path}: uses {name}, which it does not import" for name in missing(path.read_text()) if not_with_package(name)]
    for path in run:
        done = subprocess.run([path, "--help"], capture_output=True, text=True, check=False)
        if done.returncode or not done.stdout:
            faults.append(f"{path} --help: status {done.returncode}, {done.stderr.strip()[-300:]}")
    print(*faults, sep="\n")
    print(f"{len(run)} scripts answer alone, {len(files)} files import what they use: {len(faults)} faults")
    return 1 if faults or len(run) < 40 else 0


if __name__ == "__main__":
    sys.exit(main())
