"""What touches in a deck and in the scene made of it, for balance.py: contacts and ties with the areas of their surfaces, and bolts with
their tension and shortening. Of contacts or ties that are given both ways one counts; ties that became common nodes count no more."""

import numpy

from .mesh.integrals import areas

KINDS = ("contacts", "ties", "bolts")


def area_of(x, faces):
    """Area of faces, arrays of their nodes."""
    return sum(float(numpy.linalg.norm(areas(x[nodes])[0], axis=1).sum()) for nodes in faces)


def of_deck(deck, faces_of, x, units):
    """Kind -> (number, two sums): areas of slaves and masters, m^2; tensions, N, and shortenings, m. faces_of: nodes of (cell, face)."""
    def rows(pairs):
        faces = [[deck.surfaces[name][0] for name in (pair.slave, pair.master)] for pair in pairs]
        return [[area_of(x, faces_of(numpy.unique(side, axis=0))) for side in both] for both in faces if all(map(len, both))]

    bolts = [(bolt.tension * units.force, 0.0 if bolt.tension else bolt.shortening * units.length) for bolt, _ in deck.bolts]
    return dict(zip(KINDS, map(summed, (rows(deck.contacts), rows(deck.ties), bolts))))


def of_scene(scene, words, sets, x):
    """The same of a scene; words: the names in one of its lists; sets: name -> arrays of nodes of faces."""
    def rows(kind):
        return [[area_of(x, sets[name.strip()]) for name in scene[entry]["surfaces"].split(",")] for entry in words(scene, kind)]

    tightened = [scene[name] for name in words(scene, "loads") if "part" in scene[name]]
    bolts = [[float(bolt.get(key, 0)) for key in ("tension", "shortening")] for bolt in tightened]
    return dict(zip(KINDS, map(summed, (rows("contacts"), rows("ties"), bolts))))


def summed(rows):
    return len(rows), numpy.sum(rows, axis=0) if rows else numpy.zeros(2)


def apart(deck, scene, same):
    """What differs: triples (what, of the deck, of the scene)."""
    for kind in KINDS:
        (n, sums), (others, other_sums) = deck[kind], scene[kind]
        if n != others or not numpy.all(abs(sums - other_sums) <= same * abs(sums)):
            yield kind, said(kind, n, sums), said(kind, others, other_sums)


def said(kind, n, sums):
    units = ("N", "m shorter") if kind == "bolts" else ("m^2 of slaves", "m^2 of masters")
    return f"{n}, " + ", ".join(f"{value:.6g} {unit}" for value, unit in zip(sums, units) if value)


def lines(found):
    """Lines of the balance."""
    return [f"{kind}: {said(kind, n, sums)}" for kind, (n, sums) in found.items() if n]
