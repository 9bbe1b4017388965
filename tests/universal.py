"""Universal files after the published layout, as the tests write them: datasets 15, 2411, 82, 164, 55, 2414, 58 and 58b. It shares nothing
with what reads them."""

import numpy

MARK = f"{-1:6d}\n"


def titles(*words):
    """Five lines."""
    return "".join(f"{word:<80}\n" for word in (*words, *(5 - len(words)) * ["NONE"]))


def rows(values, width, digits, per):
    """Numbers in columns, so many in a line."""
    text = [f"{value:{width}.{digits}E}" for value in values]
    return "".join("".join(text[k:k + per]) + "\n" for k in range(0, len(text), per))


def whole(*values):
    return "".join(f"{value:10d}" for value in values) + "\n"


def block(number, text, head=""):
    return f"{MARK}{number:6d}{head}\n{text}{MARK}".encode()


def units(length, force=1.0):
    return block(164, f"{9:10d}{'USER_DEFINED':<20}{1:10d}\n"
                 + f"{length:25.17E}{force:25.17E}{1.0:25.17E}\n{0.0:25.17E}\n".replace("E", "D"))


def nodes(places, number=2411, system=0):
    """Places by label."""
    if number == 15:
        return block(15, "".join(f"{label:10d}{0:10d}{system:10d}{8:10d}" + rows(place, 13, 5, 3) for label, place in places.items()))
    return block(2411, "".join(whole(label, 1, system, 11) + rows(place, 25, 16, 3).replace("E", "D") for label, place in places.items()))


def cylinder(label, number=2420):
    """A cylindrical coordinate system about the z axis of space."""
    if number == 18:
        return block(18, whole(label, 1, 0, 8, 1) + "CYL\n" + rows((0, 0, 0, 1, 0, 0), 13, 5, 6) + rows((1, 0, 1), 13, 5, 6))
    return block(2420, whole(1) + "PART\n" + whole(label, 1, 0) + "CYL\n" + "".join(rows(row, 25, 16, 3)
                                                                                    for row in (*numpy.eye(3), (0, 0, 0))))


def trace(labels, name="lines"):
    labels = list(labels)
    return block(82, whole(1, len(labels), 1) + f"{name:<80}\n" + "".join(whole(*labels[k:k + 8]) for k in range(0, len(labels), 8)))


def shape(values, freq, damping, number, growth=None, dataset=55):  # pylint: disable=too-many-arguments
    """A mode: values [3] by label; complex ones with growth (1/s) as a complex mode, else as a real one; in dataset 55 or 2414."""
    is_complex = growth is not None
    head = whole(1, 3 if is_complex else 2, 2, 8, 5 if is_complex else 2, 3) + whole(2, 6 if is_complex else 4, 1, number)
    facts = (growth, 2 * numpy.pi * freq, 0, 0, 0, 0) if is_complex else (freq, 1.0, damping, 0.0)
    text = titles(f"MODE {number}") + head + rows(facts, 13, 5, 6)
    if dataset == 2414:
        line = whole(1, 3 if is_complex else 2, 2, 8, 5 if is_complex else 2, 3)
        none = 6 * (0,)
        of = (none, (growth, 2 * numpy.pi * freq, 0, 0, 0, 0)) if is_complex else ((0, freq, 0, 1, damping, 0), none)
        text = whole(number) + f"{'Mode':<80}\n" + whole(1) + titles(f"MODE {number}") + line + whole(1, 1, 1, 0, 1, number, 0, 0) \
            + whole(*8 * [0]) + rows(of[0], 13, 5, 6) + rows(of[1], 13, 5, 6)
    for label, row in values.items():
        row = numpy.stack([row.real, row.imag], axis=1).ravel() if is_complex else numpy.real(row)
        text += whole(label) + rows(row, 13, 5, 6)
    return block(dataset, text)


def function_head(response, reference, freq, count, form, even, numerator=8):
    """Eleven lines of dataset 58: node and direction of response and force."""
    step = (freq[0], freq[1] - freq[0]) if even else (0.0, 0.0)
    return (titles("FRF") + f"{4:5d}{1:10d}{1:5d}{0:10d} {'NONE':<10}{response[0]:10d}{response[1]:4d} "
            f"{'NONE':<10}{reference[0]:10d}{reference[1]:4d}\n"
            + f"{form:10d}{count:10d}{int(even):10d}{step[0]:13.5E}{step[1]:13.5E}{0.0:13.5E}\n"
            + "".join(f"{kind:10d}{0:5d}{0:5d}{0:5d} {name:<20} {unit:<20}\n"
                      for kind, name, unit in ((18, "Frequency", "Hz"), (numerator, "Motion", "m"), (13, "Force", "N"),
                                               (0, "NONE", "NONE"))))


def function(freq, values, response, reference, form=6, even=True, numerator=8, binary=""):
    """A frequency response, form 5 of single or 6 of double precision; binary: "<" or ">"."""
    parts = numpy.stack([values.real, values.imag], axis=1)
    columns = parts if even else numpy.column_stack([freq, parts])
    head = function_head(response, reference, freq, len(values), form, even, numerator)
    if binary:
        raw = columns.astype(f"{binary}f{4 if form == 5 else 8}").tobytes()
        first = f"{58:6d}b{1 if binary == '<' else 2:6d}{2:6d}{11:12d}{len(raw):12d}{0:6d}{0:6d}{0:12d}{0:12d}\n"
        return (MARK + first + head).encode() + raw + MARK.encode()
    if form == 5:
        text = rows(columns.ravel(), 13, 5, 6)
    elif even:
        text = rows(columns.ravel(), 20, 12, 4)
    else:
        text = "".join(f"{f:13.5E}{re:20.12E}{im:20.12E}\n" for f, re, im in columns)
    return block(58, head + text)
