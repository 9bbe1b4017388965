"""Friction laws of contacts, as src/contact/law/ has them: a row for each word of -contact_friction_law."""

import math
from dataclasses import dataclass
from typing import Callable

from .tables import BadInput
from .report.markup import figures


@dataclass(frozen=True)
class Law:
    """first: the parameter that stands for the law in a headline. mu: friction coefficient, of numbers by name and the slip speed.
    words: a sentence, of texts by name and of numbers in SI by name and unit. fixed: mu is the same at every stated speed."""
    first: str
    names: tuple[str, ...]
    mu: Callable
    words: Callable
    fixed: bool = False


def coulomb_words(text, si):
    slope = si("mu_slope", "s/m")
    return f"friction coefficient {text('mu')}{f', its slope {figures(slope, 4)} s/m' if slope else ''}"


def static_kinetic_mu(p, speed):
    return p["mu_kinetic"] + (p["mu_static"] - p["mu_kinetic"]) * math.exp(-speed / p["mu_decay_speed"])


def static_kinetic_words(text, si):
    return (f"friction coefficient {text('mu_static')} at rest, {text('mu_kinetic')} in fast sliding, "
            f"decay speed {figures(si('mu_decay_speed', 'm/s'), 4)} m/s")


def stribeck_mu(p, speed):
    fall = (p["mu_static"] - p["mu_kinetic"]) * math.exp(-(speed / p["mu_stribeck_speed"])**2)
    return p["mu_kinetic"] + fall + p["mu_viscous"] * speed


def stribeck_words(text, si):
    viscous = si("mu_viscous", "s/m")
    return (f"friction coefficient {text('mu_static')} at rest, {text('mu_kinetic')} beyond the Stribeck speed "
            f"{figures(si('mu_stribeck_speed', 'm/s'), 4)} m/s{f', and {figures(viscous, 4)} s/m viscous' if viscous else ''}")


def table_mu(_, __):
    raise BadInput("friction_law table: the friction coefficient changes with the pressure, which a deck cannot say")


def table_words(text, _):
    factor = text("mu_factor")
    return (f"friction coefficient of the table {text('mu_file')} over slip speed and pressure"
            f"{f', times {factor}' if factor not in ('0', '1') else ''}")


LAWS = {
    "coulomb": Law("mu", ("mu",), lambda p, _: p["mu"], coulomb_words, fixed=True),
    "static_kinetic": Law("mu_static", ("mu_static", "mu_kinetic", "mu_decay_speed"), static_kinetic_mu, static_kinetic_words),
    "table": Law("mu_file", ("mu_factor",), table_mu, table_words),
    "stribeck": Law("mu_static", ("mu_static", "mu_kinetic", "mu_viscous", "mu_stribeck_speed"), stribeck_mu, stribeck_words),
}


def law_of(word, where):
    """The row of a word."""
    if word not in LAWS:
        raise BadInput(f"{where}: friction law {word} is none of {', '.join(LAWS)}")
    return LAWS[word]
