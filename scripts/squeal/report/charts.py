"""Pictures of lines and points as SVG, written twice, for wide and for narrow screens, so that text keeps its size.
Text stays text; each mark tells its numbers when it is pointed at (an element `title`). Colours are classes of
page.css. Values are in the units of the axes."""

import itertools
import math

import numpy

from .markup import Markup, attribute, figures, join, tag

WIDTHS = {"wide": 1120, "half": 540, "narrow": 372}  # points of the screen
LETTER = 6.6  # width of a letter of the labels
LEFT, RIGHT, TOP, BOTTOM, BETWEEN = 58, 14, 24, 44, 34


def round_step(span, most):
    """A step of 1, 2 or 5 times a power of ten that divides a span into `most` parts or less."""
    raw = span / max(most, 1)
    power = 10.0**math.floor(math.log10(raw))
    return power * next(m for m in (1, 2, 5, 10) if m * power >= raw * (1 - 1e-9))


class Axis:
    """A range of values with its name; `log`: equal ratios are equally long."""

    def __init__(self, title, low, high, log=False):
        self.title, self.log = title, log and low > 0
        if not high > low:
            low, high = (low / 2, low * 2) if self.log else (low - (abs(low) or 1) / 2, high + (abs(high) or 1) / 2)
        self.low, self.high = low, high

    @classmethod
    def about(cls, title, values, zero=False, room=0.06, log=False):
        """A range that holds the values, and zero if asked."""
        values = numpy.asarray(list(values), float)
        values = values[numpy.isfinite(values) & ((values > 0) if log else True)]
        low, high = (values.min(), values.max()) if len(values) else (0.1 if log else 0.0, 1.0)
        if log:
            return cls(title, low / 2, 2 * high, True)
        low, high = (min(low, 0.0), max(high, 0.0)) if zero else (low, high)
        pad = room * (high - low) or room * abs(high) or 1.0
        return cls(title, low - pad, high + pad)

    def place(self, value, first, last):
        """From a value to a place between two ends."""
        value = numpy.asarray(value, float)
        low, high = self.low, self.high
        if self.log:
            low, high, value = math.log(low), math.log(high), numpy.log(numpy.maximum(value, 1e-300))
        return first + (last - first) * (value - low) / (high - low)

    def ticks(self, most):
        """Values and texts."""
        if self.log:
            decades = range(math.ceil(math.log10(self.low) - 1e-9), math.floor(math.log10(self.high) + 1e-9) + 1)
            if len(decades) >= 2:
                return [(10.0**d, figures(10.0**d)) for d in decades[::-(-len(decades) // max(most, 1))]]
        step = round_step(self.high - self.low, most)
        first = math.ceil(self.low / step - 1e-9)
        last = math.floor(self.high / step + 1e-9)
        return [(i * step, figures(i * step)) for i in range(first, last + 1) if not self.log or i > 0]


def path_of(x, y):
    """The d of a path; points that are not numbers interrupt it."""
    pieces, down = [], False
    for a, b in zip(x, y):
        good = math.isfinite(a) and math.isfinite(b)
        if good:
            pieces.append(f"{'L' if down else 'M'}{a:.1f} {b:.1f}")
        down = good
    return "".join(pieces)


def thinned(x, y, width):
    """Extremes of pieces, one for each point of the screen, where a line has more than two points for each."""
    piece = int(len(x) / width)
    if piece <= 1:
        return x, y
    n = len(x) // piece * piece
    blocks = numpy.asarray(y)[:n].reshape(-1, piece)
    return numpy.repeat(numpy.asarray(x)[:n:piece], 2), numpy.stack([blocks.min(1), blocks.max(1)], axis=1).ravel()


def titled(name, tip, **attributes):
    """An element with what it tells."""
    return tag(name, tag("title", tip) if tip else None, **attributes)


class Panel:
    """One frame with an axis of values: things are added in the order in which they cover one another."""

    def __init__(self, y, height):
        self.y, self.height, self.items, self.labels = y, height, [], []

    def line(self, x, y, colour, tip=None, **style):
        """Through points."""
        self.items.append(lambda place: titled("path", tip, d=path_of(*place(*thinned(x, y, place.width()))),
                                               class_=f"line {colour}", **style))

    def points(self, x, y, colour, tips, radius=3.5, data=None):
        """Dots; `data`: attributes of each."""
        data = data or itertools.repeat({})
        self.items.append(lambda place: [
            titled("circle", tip, cx=f"{a:.1f}", cy=f"{b:.1f}", r=radius, class_=f"dot {colour}", **more)
            for a, b, tip, more in zip(*place(x, y), tips, data) if math.isfinite(a) and math.isfinite(b)])

    def marks(self, x, y, sign, colour, tips):
        """Triangles and the like: up, down, square, cross."""
        shapes = {"up": "M-6 5L0 -6L6 5Z", "down": "M-6 -5L0 6L6 -5Z", "square": "M-5 -5H5V5H-5Z",
                  "cross": "M-5 -5L5 5M-5 5L5 -5"}
        self.items.append(lambda place: [
            titled("path", tip, d=shapes[sign], transform=f"translate({a:.1f} {b:.1f})", class_=f"mark {sign} {colour}")
            for a, b, tip in zip(*place(x, y), tips)])

    def boxes(self, x, y, colours, tips):
        """Rectangles: x and y are [n][2], low and high."""
        x, y = numpy.reshape(x, (-1, 2)), numpy.reshape(y, (-1, 2))

        def draw(place):
            (a, c), (b, d) = place(x[:, 0], y[:, 1]), place(x[:, 1], y[:, 0])
            return [titled("rect", tip, x=f"{l:.2f}", y=f"{t:.2f}", width=f"{max(r - l, 0.4):.2f}",
                           height=f"{max(u - t, 0.3):.2f}", **({"style": f"fill:{colour}"} if colour[0] == "#" else
                                                              {"class_": f"box {colour}"}))
                    for l, t, r, u, colour, tip in zip(a, c, b, d, colours, tips)]

        self.items.append(draw)

    def patches(self, shapes, colours, tips):
        """Areas of several polygons [k][2] each."""
        def ring(place, corners):
            return path_of(*place(*numpy.transpose(corners))) + "Z"

        self.items.append(lambda place: [
            titled("path", tip, d="".join(ring(place, corners) for corners in polygons), style=f"fill:{colour};stroke:{colour}")
            for polygons, colour, tip in zip(shapes, colours, tips) if polygons])

    def errors(self, x, y, error, colour):
        """Bars from y - error to y + error."""
        x, y, error = (numpy.asarray(values, float) for values in (x, y, error))

        def draw(place):
            a, low = place(x, y - error)
            return tag("path", d="".join(f"M{p:.1f} {q:.1f}V{r:.1f}M{p - 3:.1f} {q:.1f}h6M{p - 3:.1f} {r:.1f}h6"
                                         for p, q, r in zip(a, low, place(x, y + error)[1])), class_=f"line {colour}")

        self.items.append(draw)

    def rule(self, x=None, y=None, colour="soft", tip=None):
        """A straight line across the frame."""
        axis = self.y
        self.items.append(lambda place: titled("path", tip, class_=f"rule {colour}", d=path_of(*(
            place([x, x], [axis.low, axis.high]) if y is None else place([place.x.low, place.x.high], [y, y])))))

    def band(self, first, last, colour, tip=None):
        """A range of the lower axis."""
        axis = self.y
        self.boxes([[first, last]], [[axis.low, axis.high]], [f"band {colour}"], [tip])

    def image(self, extent, source, about):
        """A picture in the frame: extent (x0, x1, y0, y1)."""
        def draw(place):
            (a, c), (b, d) = place(extent[:2], extent[2:])
            return tag("image", tag("title", about), href=source, x=f"{a:.1f}", y=f"{d:.1f}", width=f"{c - a:.1f}",
                       height=f"{b - d:.1f}", preserveAspectRatio="none")

        self.items.append(draw)

    def label(self, x, y, text, colour="ink"):
        """A text beside a point, where it covers no other text; those that find no room are left out."""
        self.labels.append((x, y, text, colour))


class Place:
    """From values to points of the screen."""

    def __init__(self, x, y, box):
        self.x, self.y, self.box = x, y, box

    def width(self):
        """Of the frame, points of the screen."""
        return self.box[2] - self.box[0]

    def __call__(self, x, y):
        left, top, right, bottom = self.box
        return self.x.place(x, left, right), self.y.place(y, bottom, top)


OFFSETS = [(0, -12), (0, 20), (10, 4), (-10, 4), (0, -28), (0, 36), (12, -18), (-12, -18), (12, 24), (-12, 24),
           (0, -42)]


def placed_labels(panel, place):
    """Texts that cover neither one another nor the frame."""
    pieces, (left, top, right, bottom) = [], place.box
    taken = [(a - 7, b - 7, a + 7, b + 7) for x, y, *_ in panel.labels for a, b in [place(x, y)]]
    for x, y, text, colour in panel.labels:
        (a,), (b,) = place([x], [y])
        width = LETTER * len(text)
        for dx, dy in OFFSETS:
            start = a + dx - (width / 2 if dx == 0 else width if dx < 0 else 0)
            box = start, b + dy - 10, start + width, b + dy + 3
            free = all(box[2] < o[0] or box[0] > o[2] or box[3] < o[1] or box[1] > o[3] for o in taken)
            if free and box[0] >= left and box[2] <= right and box[1] >= top and box[3] <= bottom:
                taken.append(box)
                pieces.append(tag("text", text, x=f"{start:.1f}", y=f"{b + dy:.1f}", class_=f"label {colour}"))
                break
    return pieces


class Chart:
    """Panels one above another over one lower axis; `square`: both axes have one scale, the height follows."""

    def __init__(self, about, x, panels, square=False):
        self.about, self.x, self.panels, self.square = about, x, panels, square

    def height_of(self, panel, width):
        """Points of the screen."""
        if self.square:
            return (width - LEFT - RIGHT) * (panel.y.high - panel.y.low) / (self.x.high - self.x.low)
        return panel.height * (0.8 if width < 400 else 1)

    def panel_frame(self, panel, place, lowest):
        """Grid, values beside it, titles."""
        left, top, right, bottom = place.box
        pieces = [tag("text", panel.y.title, x=left - LEFT + 2, y=top - 9, class_="title")]
        for value, text in panel.y.ticks(max(2, int((bottom - top) / 42))) if panel.y.title else ():
            y = f"{place([self.x.low], [value])[1][0]:.1f}"
            pieces += [tag("path", d=f"M{left} {y}H{right}", class_="grid"),
                       tag("text", text, x=left - 6, y=y, dy="0.35em", class_="tick end")]
        room = 1.4 * LETTER * max(len(text) for _, text in self.x.ticks(4)) + 14
        for value, text in self.x.ticks(min(10, max(2, int((right - left) / room)))):
            x = f"{place([value], [panel.y.low])[0][0]:.1f}"
            pieces.append(tag("path", d=f"M{x} {top}V{bottom}", class_="grid"))
            if lowest:
                pieces.append(tag("text", text, x=x, y=bottom + 16, class_="tick middle"))
        if lowest:
            pieces.append(tag("text", self.x.title, x=right, y=bottom + 36, class_="title end"))
        return pieces

    def svg(self, kind, name):
        """The picture at one width."""
        width, above, pieces = WIDTHS[kind], TOP, []
        for i, panel in enumerate(self.panels):
            box = LEFT, above, width - RIGHT, above + self.height_of(panel, width)
            place = Place(self.x, panel.y, box)
            clip = f"{name}-{kind}-{i}"
            frame = tag("rect", x=box[0] - 6, y=f"{box[1] - 6:.1f}", width=box[2] - box[0] + 12,
                        height=f"{box[3] - box[1] + 12:.1f}")
            pieces += [self.panel_frame(panel, place, i == len(self.panels) - 1),
                       tag("clipPath", frame, id=clip),
                       tag("g", [item(place) for item in panel.items], clip_path=f"url(#{clip})"),
                       placed_labels(panel, place)]
            above = box[3] + BETWEEN
        height = above - BETWEEN + BOTTOM
        head = "".join(attribute(*pair) for pair in (
            ("class", f"chart {kind}"), ("viewBox", f"0 0 {width} {height:.0f}"), ("role", "img"),
            ("aria-label", self.about)))
        return Markup(f"<svg{head}>{join(pieces)}</svg>")

    def markup(self, name, kind="wide"):
        """For both screens; `kind`: wide or half on the wide one."""
        return join([self.svg(kind, name), self.svg("narrow", name)])
