"""Elements of HTML with everything escaped, numbers for people, sortable tables, figures with the command that makes
them."""

import html
import math
from typing import Callable, NamedTuple

from ..picture import MINUS

EMPTY = {"meta", "img", "input", "br", "link"}
LONG = 60  # letters of a fact that has a line of its own
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class Markup(str):
    """Text that is HTML already."""


def attribute(name, value):
    """As it stands in a tag; class_ is class, data_mode is data-mode; True stands alone, None and False are left
    out."""
    name = name.rstrip("_").replace("_", "-")
    if value is None or value is False:
        return ""
    return f" {name}" if value is True else f' {name}="{html.escape(str(value))}"'


def tag(name, /, *content, **attributes):
    """An element; what is no Markup is escaped."""
    begin = f"<{name}{''.join(attribute(*pair) for pair in attributes.items())}>"
    return Markup(begin if name in EMPTY else f"{begin}{join(content)}</{name}>")


def join(content):
    """Pieces one after another; lists are opened, None is nothing."""
    pieces = []
    for piece in content:
        if isinstance(piece, Markup):
            pieces.append(piece)
        elif isinstance(piece, str):
            pieces.append(html.escape(piece, quote=False))
        elif piece is not None:
            pieces.append(join(piece))
    return Markup("".join(pieces))


def figures(value, digits=6):
    """A number with that many digits, powers of ten raised."""
    if not math.isfinite(value):
        return "–"
    text = f"{value + 0.0:.{digits}g}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        text = f"{mantissa} × 10{str(int(exponent)).translate(SUPERSCRIPT)}".removeprefix("1 × ")
    return text.replace("-", MINUS)


def signed(value, digits=4):
    """With its sign; zero has none."""
    return ("+" if value > 0 else "") + figures(value, digits)


def fixed(value, decimals):
    """A number with that many decimals."""
    return f"{value:.{decimals}f}".replace("-", MINUS) if math.isfinite(value) else "–"


def count(n, one, many=None):
    """3 modes, 1 mode."""
    return f"{n} {one if n == 1 else many or one + 's'}"


class Column(NamedTuple):
    """Of a table: heading with its unit, cell of a row, text of a cell; `left`: words, not numbers."""
    title: str
    value: Callable
    text: Callable = str
    left: bool = False
    hint: str = ""


def cell(column, row):
    """One value, as it is beside how it is shown."""
    value = column.value(row)
    raw = f"{value:.15g}" if isinstance(value, (int, float)) else str(value)
    missing = isinstance(value, float) and math.isnan(value)
    shown = "–" if missing else column.text(value)
    same = not column.left and raw == shown
    return tag("td", shown, class_="left" if column.left else None, data_value=None if same else raw)


def table(name, columns, rows, mark=lambda row: None, data=lambda row: {}):
    """A table whose headings sort it. `mark` gives a row its class, `data` other attributes."""
    head = [tag("th", tag("button", column.title, type="button"), scope="col", title=column.hint or None,
                class_="left" if column.left else None) for column in columns]
    body = [tag("tr", [cell(column, row) for column in columns], class_=mark(row), **data(row)) for row in rows]
    return tag("div", tag("table", tag("thead", tag("tr", head)), tag("tbody", body), class_="sortable", id=name),
               class_="scroll", tabindex="0", role="region", aria_label=name)


def pairs(rows):
    """A list of facts: name and value."""
    return tag("dl", [tag("div", tag("dt", name), tag("dd", value), class_="long" if len(value) > LONG else None)
                      for name, value in rows])


def legend(entries):
    """Colours and what they stand for: (class of the colour, sign, name)."""
    return tag("ul", [tag("li", tag("i", class_=f"key {sign} {colour}"), name) for colour, sign, name in entries],
               class_="legend")


def scale(colour_at, last):
    """Colours from 0 to `last`, a text; colour_at: of a share from 0 to 1."""
    stops = ", ".join(colour_at(i / 8) for i in range(9))
    return tag("div", tag("span", "0"), tag("i", style=f"background: linear-gradient(90deg, {stops})"),
               tag("span", last), class_="scale")


def command(text):
    """A command to copy."""
    return tag("div", tag("code", text), tag("button", "Copy", type="button", class_="copy"), class_="command")


def figure(name, title, picture, said="", made_by=None):
    """A picture with its title, a sentence about it, and the command that makes it again."""
    caption = tag("figcaption", tag("h4", title), tag("p", said) if said else None)
    return tag("figure", caption, picture, command(made_by) if made_by else None, id=name)


def missing(text):
    """What is not there, and why."""
    return tag("p", text, class_="missing")


def section(name, title, *content, level=3):
    """A part of the page with its heading."""
    return tag("section", tag(f"h{level}", title), content, id=name)


class Part:
    """What an analysis gives to the page: its section, (source of data_script(), bodies) or None, (name, text) of its
    errors, its verdict."""

    def __init__(self, content, bodies=None, errors=(), verdict=""):
        self.content, self.bodies, self.errors, self.verdict = content, bodies, list(errors), verdict
