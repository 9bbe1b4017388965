"""The page: folders one after another, what they have in common first, in one file without any other."""

from pathlib import Path
from typing import NamedTuple

from ..tables import BadInput
from .boxes import design_part, quiet_part
from .compare import compare_section
from .folders import Folder
from .markup import Markup, Part, count, join, missing, section, tag
from .models import model_part
from .modes import modes_part
from .origin import origin_section, scene_section
from .responses import response_part
from .samples import conditions_part, sample_part
from .statics import static_part
from .sweeps import sweep_part
from .transients import transient_part
from .vibrations import cycle_part, map_part

HERE = Path(__file__).resolve().parent
WORKER = "dense", "hessenberg", "follow", "statuses", "reduced"  # what computes the modes of a reduced model
LARGEST = 10e6  # bytes of the page
SHARES = 0.7, 0.35, 0.15, 0.0  # of them for shapes: the first one with which the page is not larger
TITLES = {"modes": "Modes", "static": "Sliding state", "sweep": "Sweep", "transient": "In time",
          "frf": "Frequency response", "map": "Map of vibration", "cycle": "Limit cycles", "sample": "Samples",
          "conditions": "Conditions", "quiet": "Quiet box", "design": "Design", "model": "The model"}
SECTIONS = {"modes": modes_part, "static": static_part, "sweep": sweep_part, "transient": transient_part,
            "frf": response_part, "map": map_part, "cycle": cycle_part, "sample": sample_part,
            "conditions": conditions_part, "quiet": quiet_part, "design": design_part, "model": model_part}


class Opening(NamedTuple):
    """What stands before the folders: its title, links (id, text) to its sections, its content."""
    title: str
    links: list
    content: list


def resource(name):
    """A file that goes into the page as it is."""
    return Markup((HERE / name).read_text())


def analysis_part(folder, kind, room):
    """One analysis; what cannot be read is a section that says so, and a line for the user."""
    try:
        return SECTIONS[kind](folder, room)
    except BadInput as error:
        return Part(section(f"{folder.key}-{kind}", TITLES[kind], folder.lacks(error)))


def article(folder, room):
    """One folder, and what it says in one line."""
    parts = {kind: analysis_part(folder, kind, room) for kind in folder.analyses}
    source, bodies = next((part.bodies for part in parts.values() if part.bodies), (None, None))
    errors = [error for part in parts.values() for error in part.errors]
    verdicts = [part.verdict for part in parts.values() if part.verdict]
    content = [tag("h2", folder.name), [tag("p", verdict, class_="lead") for verdict in verdicts]]
    if not folder.analyses:
        return tag("article", content, missing(f"{folder.wrong[0]}."), id=folder.key), "no result"
    return tag("article", content, scene_section(folder, source, bodies), [part.content for part in parts.values()],
               origin_section(folder, errors), id=folder.key), " ".join(verdicts)


def links_to(name, title, links):
    """An article and its sections."""
    return tag("li", tag("a", title, href=f"#{name}"),
               tag("ul", [tag("li", tag("a", text, href=f"#{place}")) for place, text in links]))


def navigation(folders, opening):
    """Links to all sections."""
    def links(folder):
        items = [(f"{folder.key}-scene", "Scene"), *((f"{folder.key}-{kind}", TITLES[kind])
                                                     for kind in folder.analyses),
                 (f"{folder.key}-origin", "Origin")] if folder.analyses else []
        return links_to(folder.key, folder.name, items)

    both = tag("li", tag("a", "Side by side", href="#all")) if len(folders) > 1 else None
    first = links_to("first", opening.title, opening.links) if opening else None
    return tag("nav", tag("ul", first, both, [links(folder) for folder in folders]), aria_label="Sections")


def subtitle(folders):
    """How many, which version, when, how many runs have not ended."""
    scenes = [folder.scene for folder in folders if folder.scene]
    versions = {scene.facts["versions"].split(",")[0] for scene in scenes if "versions" in scene.facts}
    ends = sorted(scene.ended() for scene in scenes if scene.ended())
    open_runs = sum("end" in scene.facts and not scene.ended() for scene in scenes)
    return ", ".join([count(len(folders), "result folder"), *sorted(versions),
                      *([f"computed {' to '.join(dict.fromkeys((ends[0], ends[-1])))}"] if ends else []),
                      *([f"{count(open_runs, 'run')} not ended"] if open_runs else [])])


def page(folders, title, opening, share):
    """All of it; share: of the largest page, for shapes."""
    first = tag("article", tag("h2", opening.title), opening.content, id="first") if opening else None
    room = share * LARGEST / max(len(folders), 1)
    head = tag("head", tag("meta", charset="utf-8"), tag("title", title),
               tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
               tag("meta", name="color-scheme", content="light dark"),
               tag("link", rel="icon", href="data:,"), tag("style", resource("page.css")))
    articles, verdicts = zip(*(article(folder, room) for folder in folders))
    body = tag("body", tag("header", tag("h1", title), tag("p", subtitle(folders), class_="quiet")),
               navigation(folders, opening),
               tag("main", first, compare_section(folders, verdicts) if len(folders) > 1 else None, articles),
               tag("script", *(resource(f"{name}.js") for name in WORKER), type="text/plain", id="reduced-code")
               if any("model" in folder.analyses for folder in folders) else None,
               tag("script", *(resource(name) for name in ("page.js", "viewer.js", "stage.js", "sliders.js"))))
    return join([Markup("<!DOCTYPE html>\n"), tag("html", head, body, lang="en")])


def write_page(paths, output, title, options, opening=None):
    """Reads the folders and writes the page; returns its name and a line for each thing that is wrong."""
    for share in SHARES:
        folders = [Folder(path, f"r{number}", options) for number, path in enumerate(paths, 1)]
        if not any(folder.analyses for folder in folders):
            raise BadInput(folders[0].wrong[0])
        text = page(folders, title, opening, share)
        if len(text.encode()) <= LARGEST:
            break
    try:
        output.write_text(text, encoding="utf-8")
    except OSError as error:
        raise BadInput(f"cannot write {output}: {error.strerror}") from None
    return output, [text for folder in folders for text in folder.wrong]
