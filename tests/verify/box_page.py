#!/usr/bin/env python3
"""The page of a quiet box or of a design beside its tables: every number of quiet.csv, the changes of a design and its corners are in it,
and the verdict has what the table says; the button of the design sets its values.

    box_page.py quiet|design RESULTS"""

import csv
import html
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/report"


def read(path):
    """Rows."""
    with path.open(newline="") as table:
        return list(csv.DictReader(table))


def table_of(page, name):
    """Values of the cells, a list a row."""
    body = re.search(rf'<table[^>]* id="r1-{name}">.*?<tbody>(.*?)</tbody>', page, re.DOTALL)[1]
    cells = [re.findall(r'<td[^>]*?(?: data-value="([^"]*)")?>(.*?)</td>', row) for row in re.findall(r"<tr[^>]*>(.*?)</tr>", body)]
    return [[html.unescape(value or text) for value, text in row] for row in cells]


def same(a, b):
    """Numbers to what a table shows."""
    return abs(float(a) - float(b)) <= 1e-12 * abs(float(b))


def check_quiet(folder, page):
    """The box of each variable; the counts."""
    columns = "own", "lower", "upper", "quiet_lower", "quiet_upper"
    rows, statement = read(folder / "quiet.csv"), read(folder / "quiet_statement.csv")[0]
    shown = table_of(page, "quiet-box")
    for row, cells in zip(rows, shown, strict=True):
        assert cells[0] == row["variable"] and all(same(cell, row[name]) for cell, name in zip(cells[1:6], columns)), (cells, row)
        half = 50 * (float(row["quiet_upper"]) - float(row["quiet_lower"])) / abs(float(row["own"]))
        assert same(cells[6], half) and same(cells[7], row["danger"]), (cells, row)
    assert f"{statement['cells']} tested" in page and f"{statement['random']}, {statement['random_unstable']} unstable" in page
    assert f"{float(statement['size']):.4g} of the box" in re.search(r'<p class="lead">(.*?)</p>', page)[1]
    states = {row["state"] for row in read(folder / "quiet_cells.csv")}
    assert all(f">{state}" in page for state in states) and page.count("the scene&#x27;s own values") + page.count("the scene's own values")


def page_of(folder):
    """Its text."""
    with tempfile.TemporaryDirectory() as name:
        page = Path(name, "page.html")
        subprocess.run([SCRIPT, folder, "-o", page], check=True, stdout=subprocess.DEVNULL)
        return page.read_text()


def button_of(page, title):
    """Values that a button of the sliders sets; None without it."""
    found = [values for values, text in re.findall(r'<button[^>]* data-values="([^"]*)"[^>]*>([^<]*)</button>', page)
             if html.unescape(text) == title]
    return json.loads(html.unescape(found[0])) if found else None


def check_button(folder, page, table, title, there):
    """It sets the values of a table and the scene's own; there is none where the table names what no slider has, or a value is missing."""
    with (folder / "reduced_model.bin").open("rb") as file:
        entries = json.loads(file.readline())["parameters"]
    assert there and button_of(page, title) == [float(there.get(entry["name"], entry["value"])) for entry in entries], title
    name, text = next(iter(there)), (folder / table).read_text()
    joined = re.sub(rf"(^|,){re.escape(name)}(,|$)", rf"\g<1>{name}+other\2", text, count=1, flags=re.MULTILINE)
    with tempfile.TemporaryDirectory() as other:
        copy = Path(other, "copy")
        shutil.copytree(folder, copy)
        for changed in (joined, text.replace(there[name], "")):
            assert changed != text
            (copy / table).write_text(changed)
            without = page_of(copy)
            assert button_of(without, "The scene's own values") and button_of(without, title) is None, (title, changed)


def check_design(folder, page):
    """The design beside the scene, one row for each one tried, corners."""
    rows, corners = read(folder / "design.csv"), read(folder / "design_corners.csv")
    found = next(row for row in rows if row["found"] == "1")
    for name, own, value, change in table_of(page, "change"):
        assert same(own, rows[0][name]) and same(value, found[name]) and same(change, 100 * (float(value) / float(own) - 1)), name
    assert len(table_of(page, "designs")) == len(rows)
    shown = table_of(page, "corners")
    for row, cells in zip(corners, shown, strict=True):
        assert int(cells[0]) == int(row["unstable"]) and same(cells[1], row["excess_rad_s"]), (cells, row)
    lead = re.search(r'<p class="lead">(.*?)</p>', page)[1]
    assert f"unstable mode at {rows[0]['unstable_scenarios']} scenarios of {rows[0]['scenarios']}" in lead, lead
    assert f"0 of {len(corners)} full solutions" in lead, lead
    names = list(found)[list(found).index("other_statuses") + 1:]
    check_button(folder, page, "design.csv", "The design's values", {name: found[name] for name in names})


def main(kind, folder):
    {"quiet": check_quiet, "design": check_design}[kind](folder, page_of(folder))
    print("the page has what the tables have")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
