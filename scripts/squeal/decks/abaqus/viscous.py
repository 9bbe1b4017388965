"""Abaqus: stiffness that depends on the frequency. G(t) = G_0 (1 - sum g_i (1 - exp(-t / tau_i))), or of each frequency Re g* and Im g*
times omega, which are G_loss / G_inf and 1 - G_storage / G_inf. squeal's law is of Young's modulus, at a constant Poisson's ratio: exact
where bulk and shear relax alike."""

import numpy

from .material import material_of, numbers

MOST = 8  # branches of a part


def do_viscoelastic(reader, _, card):
    """Rows of a series or table; done when the modulus is known."""
    material = material_of(reader, card)
    kinds = {word: card.options.pop(word, "").upper() for word in ("TIME", "FREQUENCY")}
    wanted = 3 if "PRONY" in kinds.values() else 5 if kinds["FREQUENCY"] == "TABULAR" else 0
    rows = [(row + [0.0] * 5)[:5] for _, row in numbers(card)]
    if not wanted or not rows:
        reader.deck.note(card.place, "*VISCOELASTIC: only PRONY, and FREQUENCY=TABULAR are read: not taken; give the part `table_...`")
        return
    reader.viscous.append((material, wanted == 3, numpy.array(rows), card.place))


def finish(reader):
    """Laws of materials whose modulus is one number."""
    for material, series, rows, place in reader.viscous:
        bad = "its modulus is not one number" if len(material.young) != 1 or material.shear else (
            prony if series else table)(reader.deck, material, rows, place, material.name in reader.instant)
        if bad:
            reader.deck.note(place, f"*VISCOELASTIC of {material.name}: {bad}: not taken")


def said(deck, place, alike):
    """What becomes of shear and bulk."""
    deck.differ(place, "*VISCOELASTIC: as a law of Young's modulus, at a constant Poisson's ratio" + (
        "" if alike else "; shear and bulk relax otherwise there"))


def prony(deck, material, rows, place, instant):
    """g, k, tau; the modulus of slow motions stays, or follows from that of fast ones. Returns what is wrong."""
    g, k, tau = rows[:, :3].T
    if len(rows) > MOST or min(g) <= 0 or sum(g) >= 1 or min(tau) <= 0:
        return f"1 to {MOST} branches with positive g, a sum of them below 1, and positive times are needed"
    fast = material.young[0] if instant else material.young[0] / (1 - sum(g))
    material.young = (fast * (1 - sum(g)),)
    material.law = ("prony_modulus", "stress", tuple(fast * g)), ("prony_time", "time", tuple(tau))
    said(deck, place, (g == k).all())
    return ""


def table(deck, material, rows, place, instant):
    """omega Re g*, omega Im g*, the same of k*, frequency. Returns what is wrong."""
    loss, less, frequency = rows[:, 0], 1 - rows[:, 1], rows[:, 4]
    order = numpy.argsort(frequency)
    if instant or min(less) <= 0 or min(loss) < 0 or frequency[order[0]] <= 0 or (numpy.diff(frequency[order]) <= 0).any():
        return "a modulus of slow motions, and rows with positive moduli and frequencies are needed"
    moduli = material.young[0] * less[order]
    material.law = (("table_frequency", "rate", tuple(frequency[order])), ("table_modulus", "stress", tuple(moduli)),
                    ("table_loss_factor", "", tuple((loss / less)[order])))
    said(deck, place, (rows[:, :2] == rows[:, 2:4]).all())
    return ""


CARDS = {"VISCOELASTIC": do_viscoelastic}
