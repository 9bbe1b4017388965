"""Whole decks of all formats for test_import_fuzz.py, some of several files, and damages of them: of bytes, digits, words, lines,
pieces, of a letter of a keyword, of an object of a file of HDF5."""

import re

import decks
import decks_abaqus
import decks_others
import numpy as np
import odd_meshes
from plain_decks import READ


def cut(random, data):
    return data[:random.integers(1, len(data))], True


def flip(random, data):
    data = bytearray(data)
    for at in random.integers(0, len(data), random.integers(1, 4)):
        data[at] ^= 1 << random.integers(0, 8)
    return bytes(data), False


def digits(random, data):
    """Other digits: wrong counts, numbers, places."""
    data = bytearray(data)
    places = [k for k, letter in enumerate(data) if chr(letter).isdigit()]
    for at in random.choice(places, min(len(places), random.integers(1, 4))) if places else ():
        data[at] = ord("0") + random.integers(0, 10)
    return bytes(data), False


def lines(random, data):
    """A line lost, twice, or in another place."""
    rows = data.split(b"\n")
    a, b, how = random.integers(0, len(rows)), random.integers(0, len(rows)), random.integers(0, 3)
    row = rows[a]
    if how < 2:
        del rows[a]
    if how > 0:
        rows.insert(min(b, len(rows)), row)
    return b"\n".join(rows), a >= len(rows) - 3


def words(random, data):
    """A number becomes a word, nothing, or one that is none."""
    found = list(re.finditer(rb"[-+.\w]+", data))
    at = found[random.integers(0, len(found))]
    new = [b"nan", b"", b"inf", b"1e999", b"-1", b"0", b"99999999999999999999", b"x", b"1,", b"0x10", b"1_0"][random.integers(0, 11)]
    return data[:at.start()] + new + data[at.end():], at.end() > len(data) - 40


def piece(random, data):
    """A piece lost, twice, or random bytes."""
    a = random.integers(0, len(data))
    b = min(len(data), a + random.integers(1, 200))
    how = random.integers(0, 3)
    middle = [b"", data[a:b] * 2, random.bytes(b - a)][how]
    return data[:a] + middle + data[b:], b > len(data) - 40


DAMAGES = (cut, flip, digits, lines, words, piece)


def keyword(random, data):
    """A letter of a line's first words becomes another, is lost, or stands twice: a keyword, parameter or label that is none."""
    rows = data.split(b"\n")
    chosen = [k for k, row in enumerate(rows) if re.match(rb"[ \t]*\*?[ \t]*(?!EIGRL)[A-Za-z]{2}", row)]  # EIGR has other fields
    k = chosen[random.integers(0, len(chosen))]
    places = [at for at, letter in enumerate(rows[k][:40]) if chr(letter).isalpha()]
    at, how = places[random.integers(0, len(places))], random.integers(0, 3)
    letter = bytes([ord("A") + random.integers(0, 26)])
    rows[k] = rows[k][:at] + [letter, b"", 2 * rows[k][at:at + 1]][how] + rows[k][at + 1:]
    return b"\n".join(rows), False


def object_changed(random, path):
    """One object of an HDF5 file: gone, shorter, of another shape or type, with another number, under another name. Whether it is gone."""
    import h5py
    with h5py.File(path, "r+") as file:
        names = []
        file.visit(names.append)
        name = names[random.integers(0, len(names))]
        node, how = file[name], random.integers(0, 6)
        attributes = list(node.attrs)
        if how == 0 or not isinstance(node, h5py.Dataset) and not attributes:
            del file[name]
            return True
        elif how == 1 and attributes:
            key = attributes[random.integers(0, len(attributes))]
            node.attrs[key] = [-1, 0, 1, 5, 10**12, 2.5, "text"][random.integers(0, 7)]
        elif how == 2 and attributes:
            del node.attrs[attributes[random.integers(0, len(attributes))]]
        elif not isinstance(node, h5py.Dataset):
            file.move(name, f"{name}_")
            return True
        else:
            data, kept = node[()], dict(node.attrs)
            flat = np.ravel(data).copy()
            at = random.integers(0, len(flat)) if len(flat) else 0
            if how == 3 and len(flat):
                flat[at] = ([np.nan, np.inf, 1e300, 0, -1] if flat.dtype.kind == "f" else [0, 1, -1, 2, 99])[random.integers(0, 5)]
            changed = [flat[:at], np.concatenate([flat, flat[:1]]), flat.astype("S8") if flat.dtype.kind != "S" else flat[:at],
                       flat, flat.reshape(-1, 1), flat.astype(float) if flat.dtype.kind in "iu" else flat[::-1]][how]
            del file[name]
            file.create_dataset(name, data=changed)
            file[name].attrs.update(kept)
    return False


class Base:
    """A whole deck: its files, of which the first is given to the importer, and its units."""

    def __init__(self, files, units="mm-t-s", plain=True):
        self.files = {name: text if isinstance(text, bytes) else text.encode() for name, text in files.items()}
        self.main, self.units, self.plain = next(iter(files)), units, plain
        self.names = re.compile(rf"[^\n]*(?:{'|'.join(map(re.escape, files))}):\d+: [^\n]+$")

    def write(self, folder, changed=()):
        for name, data in {**self.files, **dict(changed)}.items():
            (folder / name).write_bytes(data)
        return folder / self.main

    def text(self, folder):
        """What the files say now, with those that are included in their place."""
        text = (folder / self.main).read_bytes()
        for name in list(self.files)[1:]:
            text = re.sub(rb"(?im)^\*INCLUDE, INPUT=" + re.escape(name.encode()) + rb"$", lambda _: (folder / name).read_bytes(), text)
        return text.replace(b"\r\n", b"\n").replace(b"\r", b"\n").decode("latin-1")


def lines_of(text):
    return "\n".join(text).rstrip("\n") + "\n"


def bases(folder, ending):
    """Whole decks of a format."""
    if ending in ("inp", "bdf", "cdb"):
        small = decks.Solid("wedge+tet1", folder, "--elements", "2,1,2")
        second = decks.Solid("hex20", folder, "--elements", "2,1,1")
    if ending == "inp":
        one = [decks.abaqus(small), decks.abaqus(second, decks.ORTHOTROPIC)]
        return [*(Base({"deck.inp": lines_of(text)}) for text in one), Base(decks_abaqus.Assembly.FILES),
                Base(decks_abaqus.Flat.FILES, decks_abaqus.Flat.UNITS), Base({"steps.inp": STEPS})]
    if ending == "bdf":
        one = [decks.nastran(small, "free"), decks.nastran(second, "large", decks.ORTHOTROPIC), decks.nastran(small, "small")]
        case = dict(decks_others.NastranCase.FILES)
        case["case.bdf"] = case["case.bdf"].partition("ENDDATA")[0] + "ENDDATA\n"
        return [*(Base({"deck.bdf": lines_of(text)}) for text in one), Base(decks_others.Nastran.FILES), Base(case, plain=False)]
    if ending == "cdb":
        one = [decks.ansys(small), decks.ansys(second, decks.ORTHOTROPIC), current(decks.ansys(second))]
        return [*(Base({"deck.cdb": lines_of(text)}) for text in one), Base(decks_others.Ansys.FILES), Base(decks_others.AnsysCase.FILES)]
    found = []
    for kind in ("hex20", "wedge+tet1"):
        path = folder / f"whole.{ending}"
        decks.meshio_file(decks.Solid(kind, folder, "--elements", "2,1,1"), path)
        found.append(Base({f"deck.{ending}": path.read_bytes()}))
    if ending == "med":
        path = folder / "made.med"
        odd_meshes.write_med(path, odd_meshes.MED["odd"][0])
        found.append(Base({"deck.med": path.read_bytes()}))
    return found


# Two steps with loads on sets that overlap, the second anew; supports of the second beside those before
STEPS = f"""{decks_abaqus.CUBE}*ELEMENT, TYPE=C3D8I, ELSET=E
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=FOOT
1, 2, 3, 4
*NSET, NSET=HEAD, GENERATE
5, 8, 1
*NSET, NSET=SIDE
2, 3, 6, 7
*SURFACE, NAME=TOP
E, S2
{decks_abaqus.STEEL}*SOLID SECTION, ELSET=E, MATERIAL=M
*BOUNDARY
FOOT, 1, 3
*STEP
*STATIC
*CLOAD
HEAD, 3, -2.
SIDE, 1, 1.
*DSLOAD
TOP, P, 0.5
*END STEP
*STEP
*STATIC
*BOUNDARY, OP=MOD
7, 1, 1, 0.01
*CLOAD, OP=NEW
SIDE, 3, 4.
*DLOAD, OP=MOD
E, P4, 0.25
*END STEP
"""


def current(lines):
    """An archive as versions from 2022 on write it: types in a block, UNBL, whole numbers of ten columns, a component twice."""
    types = [line.split(",")[1:] for line in lines if line.startswith("ET,")]
    block = [f"ETBLOCK,{len(types):9d},{len(types):9d}", "(2i9,19a9)",
             *(f"{int(number):9d}{int(kind):9d}" + f"{0:9d}" * 19 for number, kind in types), "       -1"]
    first = next(k for k, line in enumerate(lines) if line.startswith("ET,"))
    rest = [line.replace("R5.0", "UNBL").replace("R5.3", "UNBL") for line in lines if not line.startswith("ET,")]
    held = next(k for k, line in enumerate(rest) if line.startswith("CMBLOCK"))
    return [*rest[:first], *block, *rest[first:held], *rest[held:held + 3], *rest[held:]]


def damaged(random, base, number, folder, ending):
    """Writes a damaged deck; what was done, whether its main file ends early, whether words or objects alone are not as they were."""
    damages = [*DAMAGES, keyword] if ending in READ else [*DAMAGES, object_changed] if ending == "med" else DAMAGES
    damage = damages[number % len(damages)]
    base.write(folder)
    if damage is object_changed:
        return damage, False, object_changed(random, folder / base.main)
    name = list(base.files)[random.integers(0, len(base.files)) if random.integers(0, 2) else 0]
    data, _ = damage(random, base.files[name])
    (folder / name).write_bytes(data)
    return damage, damage is cut and name == base.main and len(data) < len(base.files[name]) - 1, damage is keyword
