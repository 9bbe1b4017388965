"""Sections that every folder has: the scene in words and as a picture, and where the numbers come from: commands,
versions, cost, options."""

import re

from .markup import Column, command, figure, fixed, missing, pairs, section, table, tag
from .shapes import viewer
from .words import scene_words

FACTS = {"completeness": "completeness of the modes", "cost": "cost", "end": "ended", "versions": "versions",
         "in": "in the folder"}


def scene_section(folder, source, bodies):
    """Words and picture; `source`: of the data_script() that has the bodies."""
    words = scene_words(folder.scene) if folder.scene else missing(f"No words about the scene: {folder.why}.")
    picture = missing("No picture of the scene: folders of modes, of a sliding state and of a run in time have the bodies.")
    if bodies:
        size = " × ".join(f"{1e3 * extent:.4g}" for extent in bodies.extent)
        where = viewer(f"{folder.key}-bodies", source, "the bodies; drag to turn them", still=True)
        said = (f"{', '.join(bodies.parts)}; {size} mm over all, {len(bodies.quads)} faces of elements on the surface. "
                "Drag to turn.")
        picture = figure(f"{folder.key}-picture", "The bodies", where, said,
                         folder.command("report"))
    return section(f"{folder.key}-scene", "Scene", tag("div", words, picture, class_="pair scene"))


def cost_of(folder):
    """ranks, seconds, megabytes; None where they are not known: scene.yaml of a run under way has those of its first table."""
    ended = folder.scene and folder.scene.ended()
    found = re.match(r"(\d+) ranks?, ([\d.]+) s, (\d+) MB", folder.scene.facts.get("cost", "") if ended else "")
    return (int(found[1]), float(found[2]), int(found[3])) if found else None


def stage_table(folder):
    """Time and memory of each stage; nothing where the run did not write them."""
    found = re.findall(r"(\w+) ([\d.]+) s (\d+) MB", folder.scene.facts.get("stages", ""))
    columns = [Column("stage", lambda row: row[0], left=True),
               Column("time, s", lambda row: float(row[1]), lambda v: fixed(v, 2), hint="of the slowest rank"),
               Column("memory, MB", lambda row: float(row[2]), lambda v: fixed(v, 0),
                      hint="at its end, all ranks together")]
    return [tag("h4", "What each stage took"), table(f"{folder.key}-stages", columns, found)] if found else None


def origin_section(folder, errors):
    """Errors and cost in one list, then commands and all options. errors: (name, text) of what each analysis says."""
    scene = folder.scene
    if not scene:
        return section(f"{folder.key}-origin", "Errors, cost, origin", pairs(errors),
                       missing(f"No cost, versions and options: {folder.why}."))
    facts = [(name if key != "cost" or scene.ended() else "cost until the first table", scene.facts[key])
             for key, name in FACTS.items() if key in scene.facts]
    commands = [(name, scene.facts[key]) for key, name in (("command", "The command of this run"),
                                                           ("repeat", "The same from its scene.yaml"))
                if key in scene.facts]
    options = [(name, value, "given") for name, value in scene.given.items()]
    options += [(name, value, "default") for name, value in scene.defaults.items()]
    columns = [Column("option", lambda row: row[0], left=True), Column("value", lambda row: row[1], left=True),
               Column("", lambda row: row[2], left=True)]
    return section(f"{folder.key}-origin", "Errors, cost, origin", pairs([*errors, *facts]),
                   stage_table(folder), [(tag("h4", name), command(text)) for name, text in commands],
                   tag("details", tag("summary", f"All {len(options)} options in force"),
                       table(f"{folder.key}-options", columns, options, lambda row: row[2])))
