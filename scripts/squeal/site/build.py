"""Sphinx on the staged pages."""

import importlib.util
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from ..tables import BadInput
from .stage import stage

NEEDED = {"sphinx": "python3-sphinx", "myst_parser": "python3-myst-parser", "furo": "furo"}
CONF = """project = "squeal"
author = copyright = "the squeal developers"
extensions = ["myst_parser"]
html_theme = "furo"
html_title = "squeal"
html_copy_source = False
html_show_sphinx = False
myst_heading_anchors = 4
pygments_style, pygments_dark_style = "friendly", "monokai"
html_css_files = ["wide.css"]
html_static_path = ["_own"]
"""
# Wide tables scroll within the page, in place of the page itself
CSS = """.table-wrapper, article table.docutils { display: block; overflow-x: auto; max-width: 100%; }
article table.docutils td, article table.docutils th { overflow-wrap: anywhere; min-width: 5em; }
"""


def check_packages():
    """What is missing, as one line."""
    missing = [package for module, package in NEEDED.items() if not importlib.util.find_spec(module)]
    if missing:
        raise BadInput(f"needs {', '.join(missing)}: apt-get install {' '.join(missing)}")


def sphinx(source, output):
    """Builds; the first warning is an error."""
    done = subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", source, output],
                          capture_output=True, text=True, check=False)
    if done.returncode:
        lines = [line.replace(f"{source}/", "") for line in done.stderr.splitlines() if line.strip()]
        raise BadInput("; ".join(lines[:5]))


def build(root, output):
    """All pages of the repository below `root` as a site in `output`, which is replaced when all of it is there."""
    check_packages()
    if output.exists() and not (output / "searchindex.js").exists():
        raise BadInput(f"-o {output}: is there, and is no site; name another folder")
    with tempfile.TemporaryDirectory() as scratch:
        source, made = Path(scratch) / "source", Path(scratch) / "site"
        (source / "_own").mkdir(parents=True)
        (source / "conf.py").write_text(CONF)
        (source / "_own/wide.css").write_text(CSS)
        count = stage(root, source)
        sphinx(source, made)
        shutil.rmtree(made / ".doctrees", ignore_errors=True)
        shutil.rmtree(output, ignore_errors=True)
        output.parent.mkdir(parents=True, exist_ok=True)
        shutil.move(made, output)
    return f"{output}/index.html: {count} pages"
