"""The scene in sentences, from the options in force."""

from ..friction import law_of
from ..picture import MINUS
from ..provenance import about_sliding
from ..tables import prefixed
from .markup import count, figures, tag

AXES = "xyz"


def numbers(text):
    """Numbers between commas; none where it is something else."""
    try:
        return [float(word) for word in text.split(",")]
    except ValueError:
        return []


def quantity(value, unit):
    """A value in the unit in which it is easily read."""
    factor, unit = prefixed(abs(value), unit)
    return f"{figures(value * factor, 4)} {unit}"


def listed(words):
    """a, b and c."""
    words = list(words)
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def vector(scene, name, unit):
    """An option with a value along each axis: 0,0,-100 reads −100 N along z; several components are all named."""
    values = zip(numbers(scene.value(name)), AXES)
    parts = [f"{quantity(scene.si(unit) * value, unit)} along {axis}".replace("^3", "³") for value, axis in values if value]
    return listed(parts) or f"0 {unit}"


def direction(text):
    """+y for 0,1,0."""
    values = numbers(text)
    if sum(bool(value) for value in values) == 1:
        i = next(i for i, value in enumerate(values) if value)
        return ("+" if values[i] > 0 else MINUS) + AXES[i]
    return f"({text})"


def grounded_words(scene, name, what, option):
    """Springs or dashpots: a value per node, of the whole set, or per area, whichever the scene gives."""
    unit = {"stiffness": "N/m", "viscosity": "N s/m"}[option]
    ways = ((f"{option}_total", unit, "in total"), (f"{option}_per_area", f"{unit}^3", "by area"), (option, unit, "per node"))
    end, unit, how = next((way for way in ways if any(numbers(scene.value(f"{name}_{way[0]}")))), ways[-1])
    return f"{name}: {what} on {scene.value(f'{name}_set')}, {vector(scene, f'{name}_{end}', unit)} {how}."


def joint_words(scene, name):
    """A bushing."""
    other = scene.value(f"{name}_b")
    ends = f"between {scene.value(f'{name}_a')} and {other}" if other else f"from {scene.value(f'{name}_a')} to the ground"
    return f"{name}: a bushing {ends}, {vector(scene, f'{name}_stiffness', 'N/m')}."


def point_words(scene, name):
    """A point that moves with a set."""
    mass = quantity(scene.si("kg") * scene.number(f"{name}_mass"), "kg")
    return f"{name}: a point that moves with {scene.value(f'{name}_set')}, with a mass of {mass}."


def mesh_words(scene):
    """Where the mesh comes from."""
    if scene.value("model_mesh"):
        return f"The mesh is the file {scene.value('model_mesh')}."
    if scene.value("terms") or any(scene.value(f"operators_{kind}_k") not in ("", "0") for kind in ("load", "dense")):
        return "The scene is given by matrices, without a mesh."
    inner, outer, thick = (1e3 * scene.number(f"rig_disc_{name}") for name in ("inner", "outer", "thickness"))
    rings = scene.value("rig_disc_elements")
    about = (f"The disc has radii of {figures(inner)} and {figures(outer)} mm, is {figures(thick)} mm thick, and has "
             f"{' × '.join(rings.split(','))} elements (rings, columns, layers).")
    if not scene.is_true("rig_pad"):
        return about
    size = " × ".join(figures(1e3 * value) for value in numbers(scene.value("rig_pad_size")))
    return (f"{about} A pad of {size} mm at radius {figures(1e3 * scene.number('rig_pad_radius'))} mm hangs on a "
            f"beam of "
            f"{figures(1e3 * scene.number('rig_beam_height'))} mm.")


def part_words(scene, name):
    """A material."""
    damping = [f"{sign} = {figures(scene.number(f'{name}_{key}'), 4)} {unit}"
               for key, sign, unit in (("alpha", "α", "1/s"), ("beta", "β", "s")) if scene.number(f"{name}_{key}")]
    moduli = ", ".join(quantity(scene.si("Pa") * value, "Pa") for value in numbers(scene.value(f"{name}_young")))
    return (f"{name}: E = {moduli}, ν = "
            f"{scene.value(f'{name}_poisson', '0.3').replace(',', ', ')}, "
            f"ρ = {figures(scene.si('kg/m^3') * scene.number(f'{name}_density'), 6)} kg/m³{''.join(f', {text}' for text in damping)}.")


def sliding_words(scene, name):
    """How an interface slides; nothing where that is not prescribed."""
    slave, _, master = scene.value(f"{name}_surfaces").partition(",")
    turn, slip = (numbers(scene.value(f"{name}_{key}")) for key in ("rotation", "slip"))
    if any(turn):
        return f"{master} turns with {vector(scene, f'{name}_rotation', 'rad/s')}"
    return f"{slave} slides towards {direction(scene.value(f'{name}_slip'))}" if any(slip) else ""


def friction_words(scene, name):
    """A friction law."""
    law = law_of(scene.value(f"{name}_friction_law", "coulomb"), name)
    return law.words(lambda parameter: scene.value(f"{name}_{parameter}", "0"),
                     lambda parameter, unit: scene.si(unit) * scene.number(f"{name}_{parameter}"))


def contact_words(scene, name):
    """An interface."""
    slave, _, master = scene.value(f"{name}_surfaces").partition(",")
    motion = sliding_words(scene, name) or "no sliding is prescribed"
    speed = scene.si("m/s") * scene.number(f"{name}_speed")
    law = "exact constraint"
    if scene.value(f"{name}_law") == "penalty":
        kn, area = numbers(scene.value(f"{name}_kn")), scene.si("N/m^3") * scene.number(f"{name}_kn_per_area")
        law = (f"normal stiffness {figures(area, 4)} N/m³" if area else "normal stiffness found by pressing" if not kn else
               f"normal stiffness {quantity(scene.si('N/m') * kn[0], 'N/m')} per pair")
        if scene.value(f"{name}_pressure_law", "linear") != "linear":
            law = f"pressure over closing by the law {scene.value(f'{name}_pressure_law')}, stiffness that at the pressure of each pair"
    if scene.value("analysis", "modes") in ("transient", "map", "cycle"):
        law = "exact contact in time"
    return (f"{name}: {slave} on {master}, {motion}{f' at {figures(speed, 4)} m/s' if speed else ''}, "
            f"{friction_words(scene, name)}; {law}.")


def load_words(scene, name):
    """A force, or a pressure."""
    place = f"{scene.value(f'{name}_set') or scene.value(f'{name}_point')}"
    ramp = scene.number(f"{name}_ramp")
    grown = f", within {figures(1e3 * ramp, 4)} ms" if ramp and scene.value("analysis") == "transient" else ""
    if scene.number(f"{name}_pressure"):
        return f"{name}: {quantity(scene.si('Pa') * scene.number(f'{name}_pressure'), 'Pa')} on {place}{grown}."
    moment = numbers(scene.value(f"{name}_moment"))
    turned = f" and {vector(scene, f'{name}_moment', 'N m')}" if any(moment) else ""
    return f"{name}: {vector(scene, f'{name}_force', 'N')}{turned} in total on {place}{grown}."


STAGED = (("loads", "the load"), ("motions", "the motion"), ("sliding", "the sliding of"), ("interferences", "the interference of"),
          ("ends", "without"))


def stage_words(scene, name):
    """What begins in a stage of the loading, and what ends."""
    given = [(scene.value(f"{name}_{option}"), what) for option, what in STAGED]
    return f"{name}: {', '.join(f'{what} {listed(names.split(chr(44)))}' for names, what in given if names)}."


LISTS = (
    ("parts", part_words),
    ("supports", lambda s, n: f"{n}: {s.value(f'{n}_set')} is held in {listed(s.value(f'{n}_fix', 'xyz'))}."),
    ("springs", lambda s, n: grounded_words(s, n, "springs", "stiffness")),
    ("dashpots", lambda s, n: grounded_words(s, n, "dashpots", "viscosity")),
    ("joints", joint_words),
    ("points", point_words),
    ("loads", load_words),
    ("motions", lambda s, n: f"{n}: {s.value(f'{n}_set')} is moved by {vector(s, f'{n}_displacement', 'm')}."),
    ("contacts", contact_words),
    ("stages", stage_words),
    ("impulses", lambda s, n: f"{n}: a blow of {vector(s, f'{n}_impulse', 'N s')} at ({s.value(f'{n}_at')}) m "
                              f"after "
                              f"{figures(1e3 * s.number(f'{n}_time'), 4)} ms."),
    ("probes", lambda s, n: f"{n}: records the motion at ({s.value(f'{n}_at')}) m."),
    ("circles", lambda s, n: f"{n}: records the motion of {s.value(f'{n}_count')} nodes on a circle of radius "
                             f"{s.value(f'{n}_radius')} m."),
)


def range_words(text):
    """6.5e9:80e9:75 reads from 6.5e9 to 80e9 in 75 values."""
    first, last, n, *how = (text.split(":") + ["", ""])[:4] if ":" in text else (text, "", "", "")
    if not last:
        return f"over {first}"
    return f"from {first} to {last} in {n} values" + (" of equal ratios" if "log" in how else "")


def analysis_words(scene):
    """What was computed."""
    kind = scene.value("analysis", "modes")
    about = "the pairs that the sliding state closes" if about_sliding(scene.value, scene.names) else "all pairs closed"
    low, high = (numbers(scene.value("modes_band")) + [0, 0])[:2]
    band = f"from {figures(low)} to {figures(high)} Hz" if high else (
        f"the {scene.value('modes_count')} nearest to {figures(scene.number('modes_target'))} Hz")
    if kind == "sweep":
        names = scene.names("sweep_parameter")
        ranges = [f"{name} {range_words(scene.value(f'sweep_values{end}'))}" for name, end in zip(names, ("", "_2"))]
        return f"Sweep of {listed(ranges)}: all modes {band}, about {about}."
    if kind == "static":
        return "Equilibrium with friction while the bodies slide."
    if kind == "transient":
        start = "the sliding state" if scene.value("dynamics_start") == "static" else "rest"
        end = figures(1e3 * scene.number("ts_max_time"), 4)
        return f"Motion in time over {end} ms, from {start}, with exact contact."
    if kind in ("map", "cycle"):
        name = "map_parameter" if kind == "map" else "cycle_parameter"
        over = f" over {listed(scene.names(name))}" if scene.value(name) else ""
        return f"{'Vibration' if kind == 'map' else 'Limit cycles'}{over}, by motion in time on a few coordinates, with exact contact."
    if kind == "frf":
        return (f"Response to 1 N at {scene.value('frf_force').replace(',', ' along ')}, "
                f"{range_words(scene.value('frf_frequencies'))}, Hz, about {about}.")
    several = {"sample": ("Samples of", "sample_variables"), "quiet": ("Quiet box over", "quiet_parameters"),
               "design": ("Design by", "design_parameters")}
    if kind == "sample" and scene.value("sample_conditions"):
        return f"Conditions of {scene.value('sample_conditions')}: all modes {band}, about {about}."
    if kind in several and scene.names(several[kind][1]):
        begin, names = several[kind]
        return f"{begin} {listed(name.replace('+', ' with ') for name in scene.names(names))}: all modes {band}, about {about}."
    return f"Complex modes {band}, about {about}, {scene.value('operators_mass', 'consistent')} mass."


def scene_words(scene):
    """All of it: a sentence for each thing."""
    groups = [tag("li", analysis_words(scene)), tag("li", mesh_words(scene))]
    for name, say in LISTS:
        for thing in scene.names(name):
            head, _, rest = say(scene, thing).partition(":")
            groups.append(tag("li", tag("b", head), f":{rest}"))
    return tag("ul", groups, class_="words")


def headline(scene):
    """One line for lists of folders."""
    parts = scene.names("parts")
    first = next(iter(scene.names("contacts")), None)
    mu = law_of(scene.value(f"{first}_friction_law", "coulomb"), first).first if first else "mu"
    return f"{scene.value('analysis', 'modes')}, {count(len(parts), 'part')}" + (
        f", {mu} {scene.value(f'{first}_{mu}', '0')}" if first else "")
