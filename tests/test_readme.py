#!/usr/bin/env python3
"""What the READMEs and pages say of the repository is so: every path that they name exists, every test of the table in
tests/validation.md is one, faults of tests/faults.py are in that of tests/quality.md and can be planted in the sources as they are, and
README.md has at most 900 words, a page 3,000, a cell of a table 160 characters. Breaks when a file is moved or changed and a README or a
fault is forgotten. Exit status: 0, or 1.

A path is a word between backticks, or in an indented block, that begins with a folder of the top; NAME in it stands for
anything. Names of C and Python files without a folder are looked for in all of them. Links are relative to the
README."""

import re
import sys
from pathlib import Path

import faults as planted

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("include/", "options/", "scripts/", "src/", "tests/")
MOST_WORDS, MOST_WORDS_PAGE, MOST_CELL = 900, 3000, 160
CELL = re.compile(r"(?<!\\)\|")
CODE = re.compile(r"`([^`]+)`|^    (.*)$", re.MULTILINE)
LINK = re.compile(r"\]\(([^)#]*)(?:#([^)]*))?\)")
FENCED = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)


def readmes():
    """Those of the top and of its folders, without what is built, and the pages beside them."""
    return [ROOT / "README.md", *(path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.md")))]


def words(text):
    """Words of code, without punctuation about them."""
    for one, line in CODE.findall(text):
        yield from (word.strip("\"'.,;:()") for word in (one or line).split())


def is_there(word):
    """Whether a word that looks like a path names something; one that does not is taken to."""
    if word.startswith(FOLDERS) and not word.endswith(".msh"):  # which the command that names it makes
        return any(ROOT.glob(word.replace("NAME", "*")))
    if re.fullmatch(r"\w+\.[ch]|\w+\.py", word):
        return any(path for folder in FOLDERS for path in (ROOT / folder).rglob(word))
    return True


def anchors(page):
    """What its headings are called in links, as on a web page of it."""
    headings = re.findall(r"^#+ (.+)$", FENCED.sub("", page.read_text()), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


def faults(readme):
    """What a README names that is not there."""
    text = readme.read_text()
    for word in words(text):
        if not is_there(word):
            yield f"there is no {word}"
    for link, anchor in LINK.findall(FENCED.sub("", text)):
        target = readme.parent / link if link else readme
        if "://" not in link and (not target.exists() or anchor and anchor not in anchors(target)):
            yield f"the link to {link}#{anchor} leads nowhere"


def too_long():
    """Pages of too many words, and rows of tables with a cell that is too long."""
    for page in readmes():
        text, name = page.read_text(), page.relative_to(ROOT)
        length, most = len(text.split()), MOST_WORDS if name == Path("README.md") else MOST_WORDS_PAGE
        if length > most:
            yield f"{name}: {length} words, more than {most}"
        for number, line in enumerate(FENCED.sub(lambda block: "\n" * block[0].count("\n"), text).splitlines(), 1):
            longest = max((len(cell.strip()) for cell in CELL.split(line)), default=0) if line.startswith("|") else 0
            if longest > MOST_CELL:
                yield f"{name}:{number}: a cell of {longest} characters, more than {MOST_CELL}"


def unknown_tests():
    """Names in the last column of the table of accuracy that are neither a case, a unit test nor one of meson.build."""
    accuracy = "".join(page.read_text() for page in (ROOT / "tests").glob("validation*.md"))
    table = re.findall(r"^\|.*\|([^|]+)\|$", accuracy, re.MULTILINE)
    known = {path.stem for path in (ROOT / "tests/cases").glob("*.toml")}
    known |= {path.stem.removeprefix("test_") for path in (ROOT / "tests/unit").glob("test_*.c")}
    meson = (ROOT / "tests/meson.build").read_text()
    known |= set(re.findall(r"test\('(\w+)-?'", meson))
    known |= {path.stem for path in (ROOT / "tests/script").glob("*.py") if f"['{path.stem}', " in meson}
    names = {name for cell in table for name in re.findall(r"`(\w+)`", cell)}
    return sorted(names - known)


def lost_faults():
    """Faults whose words are not in the sources any more, or that tests/quality.md does not list with their tests."""
    table = (ROOT / "tests/quality.md").read_text().splitlines()
    for what, name, text, _, tests in planted.FAULTS:
        if text not in (ROOT / name).read_text():
            yield f"tests/faults.py: {what}: {name} does not hold {text!r}"
        row = f"| {what} | {', '.join(f'`{test}`' for test in tests.split())} |"
        if row not in table:
            yield f"tests/quality.md: there is no row {row}"


def main():
    found = [f"{readme.relative_to(ROOT)}: {fault}" for readme in readmes() for fault in faults(readme)]
    found += [f"tests/validation*.md: there is no test {name}" for name in unknown_tests()]
    found += [*lost_faults(), *too_long()]
    length = len((ROOT / "README.md").read_text().split())
    n_words = sum(word.startswith(FOLDERS) for readme in readmes() for word in words(readme.read_text()))
    if n_words < 50:
        found.append(f"only {n_words} paths in {len(readmes())} READMEs: are they read as they are written?")
    print("\n".join(found) or f"{len(readmes())} READMEs, {n_words} paths, all there; README.md has {length} words")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
