"""What the page of scripts/report says of each analysis, against the files that squeal wrote, read here on their own.
Used by test_report.py; `t` keeps what is wrong, `page` finds elements, `key` is the folder's prefix."""

import base64
import csv
import json
import math
import re
import shutil

import h5py
import numpy


def rows_of(path):
    with path.open(newline="") as lines:
        return list(csv.DictReader(lines))


def close(found, expected, tolerance):
    """Whether all numbers agree within an absolute tolerance."""
    found, expected = (numpy.asarray(list(values), float) for values in (found, expected))
    return found.shape == expected.shape and bool((abs(found - expected) <= tolerance).all())


def same_numbers(page, table, title, rows, column, factor=1.0):
    """Whether a column of the page is one of the file, to its last digit but one."""
    found = [float(row[title]) for row in page.table(table)]
    return len(found) == len(rows) > 0 and close(found, [factor * float(row[column]) for row in rows],
                                                 1e-14 * max(abs(float(row[column]) * factor) for row in rows))


def straight(pixels, values):
    """Whether places on the screen are a straight line of values, within the rounding to a tenth."""
    pixels, values = (numpy.array(list(v), float) for v in (pixels, values))
    line = numpy.polyfit(values, pixels, 1)
    return len(values) > 2 and abs(line[0]) > 0 and abs(numpy.polyval(line, values) - pixels).max() < 0.11


def check_modes(t, page, key, folder):
    """Table, chart and shares: breaks when a row, a unit or a column is mixed up."""
    rows = rows_of(folder / "modes.csv")
    for title, column, factor in (("mode", "mode", 1), ("freq, Hz", "freq_hz", 1), ("growth, 1/s", "growth_rad_s", 1),
                                  ("damping, %", "damping_ratio", 100), ("error, Hz", "error_hz", 1),
                                  ("condition", "condition", 1), ("backward error", "backward_error", 1),
                                  ("beam, %", "part_beam_percent", 1)):
        t.check(same_numbers(page, f"{key}-table", title, rows, column, factor), f"{key}: {title} of the table")
    t.check([row["label"] for row in page.table(f"{key}-table")] == [row["label"] for row in rows], f"{key}: labels")
    by_mode = {row["mode"]: row for row in rows}
    for kind in ("wide", "narrow"):
        svg = page.find("svg", inside=f"{key}-eigenvalues", class_=f"chart {kind}")
        t.check(len(svg) == 1, f"{key}: one {kind} chart")
    dots = page.find("circle", inside=f"{key}-eigenvalues")
    wide = dots[:len(dots) // 2]
    t.check(sorted(int(e["data-shape"]) for e in wide) == sorted(int(mode) for mode in by_mode), f"{key}: a dot a mode")
    chosen = [by_mode[e["data-shape"]] for e in wide]
    t.check(straight((e["cx"] for e in wide), (row["freq_hz"] for row in chosen)), f"{key}: dots over frequency")
    if any(float(row["growth_rad_s"]) for row in rows):
        t.check(straight((e["cy"] for e in wide), (row["growth_rad_s"] for row in chosen)), f"{key}: dots over growth")
    told = all(f"{float(row['freq_hz']):.3f} Hz" in e["text"] and ("UNSTABLE" in e["text"]) == (row["unstable"] == "1")
               for e, row in zip(wide, chosen))
    t.check(told, f"{key}: each dot tells its frequency and whether it grows")
    boxes = page.find("rect", inside=f"{key}-parts", class_="box green")
    shares = [float(row["part_beam_percent"]) for row in rows]
    seen = [(e["height"], share) for e, share in zip(boxes, shares) if share > 1]
    t.check(len(boxes) == 2 * len(rows) and straight(*zip(*seen)), f"{key}: shares of the beam")
    t.check(same_numbers(page, f"{key}-table", "label, %", rows, "label_percent"), f"{key}: what labels explain")
    check_effects(t, page, key, folder / "modes_effects.csv")
    unstable = {row["mode"] for row in rows if row["unstable"] == "1"}
    check_components(t, page, key, folder / "modes_components.csv", unstable)
    check_sensitivities(t, page, key, folder / "modes_sensitivities.csv", unstable)


def check_components(t, page, key, path, unstable):
    """Bars of the free modes of unstable modes from 2 % on: breaks when a share is lost or another one's bar is drawn."""
    if not path.exists():
        return
    shares = {f"{row['body']} {row['name']}": float(row["share_percent"]) for row in rows_of(path)
              if row["mode"] in unstable and abs(float(row["share_percent"])) >= 2}
    boxes = first_half(page.find("rect", inside=f"{key}-components"))
    bars = {box["text"].split(" Hz: ")[1].rsplit(" ", 2)[0]: float(box["height"]) for box in boxes if " Hz: " in box["text"]}
    t.check(bars.keys() == shares.keys() and straight([bars[name] for name in shares], [abs(v) for v in shares.values()]),
            f"{key}: bars {sorted(bars)}, shares {sorted(shares)}")


def check_sensitivities(t, page, key, path, unstable):
    """The parameters of unstable modes: breaks when a row is another mode's, or a larger effect is left out."""
    if not path.exists():
        return
    shown = page.table(f"{key}-sensitivities-table")
    for mode in unstable:
        rows = sorted((row for row in rows_of(path) if row["mode"] == mode and float(row["growth_rad_s_per_percent"])),
                      key=lambda row: -abs(float(row["growth_rad_s_per_percent"])))[:6]
        own = [cell for cell in shown if cell["mode"] == mode]
        t.check([cell["parameter"] for cell in own] == [row["parameter"] for row in rows] and all(
            math.isclose(float(cell["growth, 1/s per %"]), float(row["growth_rad_s_per_percent"]), rel_tol=1e-9)
            for cell, row in zip(own, rows)), f"{key}: parameters of mode {mode}")


def check_effects(t, page, key, path):
    """What stops a mode, in g and N/mm, and of changes between two nodes the best: breaks when a unit or a row is mixed up."""
    if not path.exists():
        return
    rows, factor = rows_of(path), {"kg": 1e3, "N/m": 1e-3, "N s/m": 1}
    shown = page.table(f"{key}-effects-table")
    nearest = {}
    for row in rows:
        if row["to_part"]:
            nearest.setdefault((row["mode"], row["change"]), []).append(row)
    nearest = [min(own, key=lambda row: float(row["first_order_units_to_zero"])) for own in nearest.values()]
    rows = [row for row in rows if not row["to_part"] or row in nearest]
    t.check(len(shown) == len(rows) > 0, f"{key}: {len(shown)} of {len(rows)} changes")
    t.check(all(math.isclose(float(cell["that would stop it"]), factor[row["unit"]] * float(row["first_order_units_to_zero"]),
                             rel_tol=1e-9) and cell["part"] == row["part"] for cell, row in zip(shown, rows)), f"{key}: amounts")


def numbers(text, kind):
    return numpy.frombuffer(base64.b64decode(text), kind)


def check_shapes(t, page, key, folder):
    """Places and displacements that the viewer gets against the field, node by node: breaks when axes, nodes, phase or
    modes are mixed up. The frame of this brake is y, x, z; 16 bits leave 2e-5."""
    data = json.loads(page.find("script", id=f"{key}-data")[0]["text"])
    with h5py.File(folder / "modes.h5") as file:
        points = file["VTKHDF/Points"][:][:, [1, 0, 2]]
        middle, half = (points.max(axis=0) + points.min(axis=0)) / 2, numpy.ptp(points, axis=0).max() / 2
        place = middle + half * numbers(data["points"], "<f4").reshape(-1, 3)
        node, before = [], -1
        for here in place:  # nodes keep their order; pad and disc have some at one place
            near = numpy.flatnonzero(numpy.linalg.norm(points - here, axis=1) < 1e-7)
            before = next((int(i) for i in near if i > before), -1)
            node.append(before)
        t.check(min(node) >= 0 and len(node) > len(points) / 3, f"{key}: places of the surface")
        for shape in data["shapes"]:
            name = f"VTKHDF/PointData/mode_{shape['number']:03d}"
            field = (file[f"{name}_re"][:] + 1j * file[f"{name}_im"][:])[:, [1, 0, 2]][node].ravel()
            moved = numbers(shape["re"], "<i2").astype(complex)
            moved += 1j * numbers(shape["im"], "<i2") if shape["im"] else 0
            factor = numpy.vdot(moved, field) / numpy.vdot(moved, moved)
            left = abs(factor * moved - field).max() / abs(field).max()
            if left > (2e-3 if shape["im"] is None else 1e-4):
                t.check(False, f"{key}: shape {shape['number']} is off by {left:.1e}")
    n_modes = len(rows_of(folder / "modes.csv"))
    t.check(len(data["shapes"]) == n_modes, f"{key}: {len(data['shapes'])} shapes of {n_modes}")


def places(elements, name):
    """Numbers of an attribute, of the wide one of two charts."""
    return numpy.array([float(e[name]) for e in elements])


def first_half(elements):
    """Of the wide chart, which stands before the narrow one."""
    return elements[:len(elements) // 2]


def path_points(d):
    """Points of a path."""
    return numpy.array([list(map(float, pair.split())) for pair in d.replace("M", "L").split("L")[1:]])


def facts_of(page, key):
    """Errors, cost and origin by name."""
    return dict(zip((e["text"] for e in page.find("dt", inside=f"{key}-origin")),
                    (e["text"] for e in page.find("dd", inside=f"{key}-origin"))))


def plain(text):
    """A number of the page."""
    text = text.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")).replace("\N{MINUS SIGN}", "-")
    return float(re.sub(r"(?:^| × )10(?=-?\d+$)", lambda found: "e" if found[0][0] == " " else "1e", text))


def check_cost(t, page, key, folder):
    """Cost, stages and completeness as the run printed them."""
    log, facts = (folder / "log.txt").read_text(), facts_of(page, key)
    printed = re.findall(r"^(\w+) +([\d.]+) +(\d+)$", log[log.index("stage  "):], re.MULTILINE)
    shown = [(row["stage"], row["memory, MB"]) for row in page.table(f"{key}-stages")]
    t.check(len(shown) > 2 and shown == [(name, memory) for name, _, memory in printed], f"{key}: stages {shown}")
    times = [float(row["time, s"]) for row in page.table(f"{key}-stages")]
    t.check(close(times, [seconds for _, seconds, _ in printed], 0.011) and "1 rank, " in facts["cost"],
            f"{key}: their time")
    said = re.search(r"^\d+ modes[^,]*, \d+ unstable[^\n]*\ncompleteness: (.*)$", log, re.MULTILINE)
    shown = facts.get("completeness of the modes", "")
    t.check(shown == said[1] if said else bool(shown) == (folder / "modes.csv").exists(),
            f"{key}: completeness '{shown}'")


def check_static(t, page, key, folder):
    """Pairs, reactions and residuals: breaks when pairs are mixed up, a status is lost, or a sum is wrong."""
    rows = rows_of(folder / "static.csv")
    for title, column, factor in (("pair", "pair", 1), ("x, mm", "x_m", 1e3), ("normal force, N", "lambda_n_n", 1),
                                  ("gap, µm", "gap_m", 1e6)):
        t.check(same_numbers(page, f"{key}-contact1-pairs", title, rows, column, factor),
                f"{key}: {title} of the pairs")
    cells = first_half([e for e in page.find("rect", inside=f"{key}-contact1-pressure") if e.get("style")])
    told = [f"pair {row['pair']}, " in e["text"] and f"normal force {float(row['lambda_n_n']):.4g} N" in e["text"]
            for e, row in zip(cells, rows) if 0.001 < float(row["lambda_n_n"])]
    t.check(len(cells) == len(rows) and all(told) and len(told) > 10,
            f"{key}: {len(told)} closed pairs tell their force")
    middle = places(cells, "x") + places(cells, "width") / 2
    t.check(len(set(numpy.round(middle, 1))) == len({row["x_m"] for row in rows}),
            f"{key}: as many columns as the pad has")
    forces = rows_of(folder / "reactions.csv")
    for axis in "xyz":
        t.check(same_numbers(page, f"{key}-reactions", f"force {axis}, N", forces, f"force_{axis}_n")
                if any(float(row[f"force_{axis}_n"]) for row in forces) else True, f"{key}: reactions along {axis}")
    n_open = sum(row["status"] == "open" for row in rows)
    t.check(n_open > 0 and f"{len(rows) - n_open} of {len(rows)} pairs closed" in page.source,
            f"{key}: {n_open} pairs open")
    facts = facts_of(page, key)
    told = re.findall(r"^  (\w+) +([\d.e+-]+)  ", (folder / "log.txt").read_text(), re.MULTILINE)
    shown = [next((plain(text) for name, text in facts.items() if name.startswith(begin)), None)
             for begin in ("largest overlap", "largest pull", "largest force across", "largest friction beyond",
                           "largest friction off")]
    t.check(len(told) == 5 and shown == [float(value) for _, value in told] and shown[0] > 0,
            f"{key}: residuals as squeal prints them: {told} {shown}")
    t.check("10⁻" in facts["forces left over, to the largest"], f"{key}: reactions in balance")


def check_words(t, page, key, said):
    """Sentences about the scene: breaks when a default, such as a pressure of 0, is taken for what the scene gives."""
    words = [e["text"] for e in page.find("li", inside=f"{key}-scene")]
    t.check(all(sentence in words for sentence in said), f"{key}: the scene in words: {words}")


def check_turned(t, folder):
    """Pairs that stand in no rows along the axes, those of the static run turned by 10 degrees: breaks when they have no
    colour, or one of another pair."""
    turned, angle = t.folder / "turned", numpy.radians(10)
    shutil.copytree(folder, turned)
    (turned / "static.h5").unlink()
    rows = rows_of(folder / "static.csv")
    for row in rows:
        x, y = float(row["x_m"]), float(row["y_m"])
        row["x_m"], row["y_m"] = x * numpy.cos(angle) - y * numpy.sin(angle), x * numpy.sin(angle) + y * numpy.cos(angle)
    with open(turned / "static.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, rows[0])
        table.writeheader()
        table.writerows(rows)
    page = t.page("turned")
    straight_cells = [e["style"] for e in first_half(page_cells(t.page(folder.name), "rect"))]
    patches = first_half(page_cells(page, "path"))
    told = [e["text"].startswith(f"pair {row['pair']}, ") for e, row in zip(patches, rows)]
    t.check(len(told) == len(rows) == len(straight_cells) and all(told), f"{len(patches)} areas of {len(rows)} turned pairs")
    t.check([e["style"].split(";")[0] for e in patches] == straight_cells, "turned pairs have the colours of those in rows")


def page_cells(page, kind):
    """Coloured areas of the pairs."""
    return [e for e in page.find(kind, inside="r1-contact1-pressure") if e.get("style", "").startswith("fill:")]


def check_sweep(t, page, key, folder):
    """Points, lines and onsets: breaks when branches or values are mixed up."""
    rows, onsets = rows_of(folder / "sweep.csv"), rows_of(folder / "onsets.csv")
    t.check(len(onsets) > 1 and same_numbers(page, f"{key}-onsets", "freq, Hz", onsets, "freq_hz") and
            same_numbers(page, f"{key}-onsets", "pad_young, GPa", onsets, "critical_value", 1e-9),
            f"{key}: {len(onsets)} onsets")
    marks = first_half([e for e in page.find("path", inside=f"{key}-branches") if "mark" in e.get("class", "")])
    at = [list(map(float, e["transform"][10:-1].split())) for e in marks]
    t.check(len(marks) == len(onsets) and straight([x for x, _ in at], [row["critical_value"] for row in onsets]) and
            straight([y for _, y in at], [row["freq_hz"] for row in onsets]),
            f"{key}: marks of the onsets in their places")
    dots = first_half([e for e in page.find("circle", inside=f"{key}-branches") if "vermilion" in e["class"]])
    growing = [row for row in rows if row["class"] == "unstable"]
    t.check(len(dots) == 2 * len(growing) > 4, f"{key}: {len(growing)} unstable points, in both panels")
    dots = [e for e in dots if float(e["cy"]) > 480]  # of the lower panel
    told = [next((row for row in growing if f"growth +{float(row['growth_rad_s']):.4g} 1/s" in e["text"]), None)
            for e in dots]
    t.check(None not in told and straight(places(dots, "cy"), [row["growth_rad_s"] for row in told]) and
            straight(places(dots, "cx"), [row["value"] for row in told]), f"{key}: growth of the unstable points")
    first = min(float(row["critical_value"]) for row in onsets if row["kind"] == "lock_in")
    t.check(f"first lock-in at pad_young {1e-9 * first:.5g} GPa" in page.source,
            f"{key}: the first lock-in, {first:.5g}")
    quiet = [e for e in page.find("path", inside=f"{key}-branches") if e.get("class") == "line quiet"]
    t.check(len(quiet) > 2, f"{key}: {len(quiet) // 2} other modes")


def check_map(t, page, key, folder):
    """A cell for each pair of values, which tells the worst mode, and a dot for each critical value: breaks when the
    parameters are mixed up, or a stable point is coloured."""
    rows, onsets = rows_of(folder / "sweep.csv"), rows_of(folder / "onsets.csv")
    points = {}
    for row in rows:
        points.setdefault((float(row["value"]), float(row["value_2"])), []).append(row)
    for name in ("growth", "family"):
        cells = first_half([e for e in page.find("rect", inside=f"{key}-map-{name}") if ": " in e["text"]])
        t.check(len(cells) == len(points) == 12, f"{key}: {len(cells)} cells of {len(points)} points")
        told = {}
        for cell in cells:
            where, what = cell["text"].split(": ", 1)
            young, mu = re.findall(r"[\d.]+", where)
            told[round(float(young), 2), float(mu)] = what, cell
        wrong = []
        for (young, mu), modes in points.items():
            what, cell = told[round(1e-9 * young, 2), mu]
            bad = [row for row in modes if row["class"] == "unstable"]
            worst = max(bad, key=lambda row: float(row["growth_rad_s"]), default=None)
            expected = f"{worst['label']} grows with {float(worst['growth_rad_s']):.4g} 1/s" if worst else "stable"
            if what != expected or (cell.get("class") == "box stable") == bool(bad):
                wrong.append((young, mu, what, expected))
        t.check(not wrong and 0 < sum("grows" in what for what, _ in told.values()) < 12,
                f"{key}: cells of the {name} map tell the worst mode {wrong[:2]}")
        dots = first_half([e for e in page.find("circle", inside=f"{key}-map-{name}") if "dark" in e["class"]])
        inside = [row for row in onsets if row["value_2"]]
        t.check(len(dots) == len(inside) > 1, f"{key}: {len(dots)} critical values")
        t.check(straight([e["cx"] for e in dots], [row["critical_value"] for row in inside]) or len(dots) < 3,
                f"{key}: they stand at their values")


def check_amplitudes(t, page, key, folder):
    """Logarithm of |c| of each mode over time, and the slope of the eigenvalue beside it: breaks when modes, parts of c
    or axes are mixed up."""
    rows, modes = rows_of(folder / "amplitudes.csv"), rows_of(folder.parent / "filters/modes.csv")
    time = numpy.array([row["time_s"] for row in rows], float)
    lines = first_half([e for e in page.find("path", inside=f"{key}-amplitudes")
                        if e.get("class", "").startswith("line ")])
    t.check(len(lines) == 6, f"{key}: {len(lines)} lines of amplitudes and eigenvalues")
    for mode, line, dashed in zip(modes, lines, lines[3:]):
        c = numpy.hypot(*(numpy.array([row[f"mode_{mode['mode']}_{part}_m"] for row in rows], float)
                          for part in ("re", "im")))
        points = path_points(line["d"])
        n = len(points)
        t.check(mode["label"] in line["text"] and n > 0.9 * len(rows)
                and straight(points[:, 1], numpy.log(c[-n:])) and straight(points[:, 0], time[-n:]),
                f"{key}: amplitude of mode {mode['mode']}, {n} points")
        scale = [numpy.polyfit(values, points[:, k], 1)[0] for k, values in enumerate((time[-n:], numpy.log(c[-n:])))]
        ends = numpy.diff(path_points(dashed["d"]), axis=0)[0] / scale
        t.check(abs(ends[1] / ends[0] - float(mode["growth_rad_s"])) < 0.3 / abs(scale[1] * ends[0]),
                f"{key}: slope {ends[1] / ends[0]:.4g} of its eigenvalue {mode['growth_rad_s']}")


def check_transient(t, page, key, folder):
    """Forces over time, summary, film: breaks when columns are mixed up, points left out, or snapshots out of order."""
    rows = rows_of(folder / "transient.csv")
    line = next(e for e in page.find("path", inside=f"{key}-forces") if e.get("class") == "line blue")
    points = path_points(line["d"])
    last = len(points)
    t.check(last == len(rows) and straight(points[:, 0], [row["time_s"] for row in rows]) and
            straight(points[:, 1], [row["normal_force_n"] for row in rows]),
            f"{key}: {last} points of the normal force")
    done = t.script("plot/transient", folder.name)
    summary = {row["quantity"]: row for row in rows_of(folder / "transient_summary.csv")} if not done.returncode else {}
    shown = {row["quantity"]: row for row in page.table(f"{key}-summary")}
    same = [name for name in shown if float(shown[name]["value"]) == float(summary.get(name,
                                                                                       {"value": "nan"})["value"])]
    t.check(len(shown) == len(same) > 8, f"{key}: {len(same)} of {len(shown)} numbers as plot/transient has them "
                                         f"{done.stderr}")
    data = json.loads(page.find("script", id=f"{key}-film-data")[0]["text"])
    times = [float(shape["detail"].split()[0]) for shape in data["shapes"]]
    t.check(len(times) > 4 and times == sorted(times), f"{key}: {len(times)} snapshots in order")
    moves = numpy.array([numbers(shape["re"], "<i2") for shape in data["shapes"]], float)
    t.check(abs(moves.mean(axis=0)).max() < 1 and abs(moves).max() > 20000, f"{key}: the film has no mean")
    check_amplitudes(t, page, key, folder)
    image = page.find("image", inside=f"{key}-spectrogram")
    t.check(image and image[0]["href"].startswith("data:image/png;base64,iVBOR"), f"{key}: a spectrogram")


def check_frf(t, page, key, folder):
    """Magnitude and phase of every output that is drawn, and the peaks."""
    rows, peaks = rows_of(folder / "frf.csv"), rows_of(folder / "peaks.csv")
    lines = first_half([e for e in page.find("path", inside=f"{key}-response")
                        if e.get("class", "").startswith("line ")])
    n = len(lines) // 2
    t.check(n == 7, f"{key}: {n} outputs")
    for above, below in zip(lines[:n], lines[n:]):
        name = above["text"]
        value = numpy.array([complex(float(row[f"{name}_re_m_n"]), float(row[f"{name}_im_m_n"])) for row in rows])
        points = path_points(above["d"])
        t.check(straight(points[:, 1], numpy.log(abs(value)))
                and straight(points[:, 0], [row["freq_hz"] for row in rows]),
                f"{key}: magnitude of {name}")
        kept = numpy.append(abs(numpy.diff(numpy.angle(value))) <= numpy.pi,
                            True)  # the line ends where it jumps a turn
        t.check(straight(path_points(below["d"])[:, 1], numpy.angle(value)[kept]), f"{key}: phase of {name}")
    t.check(same_numbers(page, f"{key}-peaks", "peak, Hz", peaks, "freq_hz") and
            same_numbers(page, f"{key}-peaks", "damping, %", peaks, "damping_ratio", 100), f"{key}: {len(peaks)} peaks")


def check_together(t, page, folders):
    """Folders side by side: every folder has its row, and what differs is what was given."""
    t.check([row["folder"] for row in page.table("overview")] == [folder.name for folder in folders], "a row a folder")
    t.check(all(float(row["memory, MB"]) > 10 for row in page.table("overview")), "a row a folder: its cost")
    differ = {row["option"]: row for row in page.table("differences")}
    t.check((differ["contact_mu"]["modes"], differ["contact_mu"]["modes_quiet"]) == ("0.9", "0") and
            "disc_poisson" not in differ, f"{len(differ)} options differ")
    rows = [row for row in rows_of(folders[0] / "modes.csv") if row["unstable"] == "1"]
    shown = page.table("all-unstable")
    t.check(len(shown) == len(rows) and close([row["growth, 1/s: modes"] for row in shown],
                                              [row["growth_rad_s"] for row in rows], 1e-9),
            "unstable modes of all folders")
