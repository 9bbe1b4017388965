"""Section of a reduced model: sliders for its parameters; eigenvalues, growth and estimated errors are computed in the browser."""

import base64
import json
import zlib

from ..tables import BadInput
from .markup import Markup, Part, count, figures, section, tag

BEYOND = 0.25  # of the range, on either side: how far sliders reach
STEPS = 400
HEADS = "frequency, Hz", "growth, 1/s", "error, rad/s", "state"


def read_model(path):
    """What its first line says, and all bytes."""
    data = path.read_bytes()
    try:
        model = json.loads(data[:data.index(b"\n")])
        n_numbers = model["n"]**2 * len(model["terms"])
        ranges = [(entry["name"], entry["lower"], entry["upper"], entry["value"]) for entry in model["parameters"]]
        if len(data) - data.index(b"\n") - 1 != 8 * n_numbers or not all(low < high for _, low, high, _ in ranges):
            raise ValueError
    except (ValueError, KeyError, TypeError):
        raise BadInput(f"{path}: is no reduced model, or is not whole") from None
    return model, data


def slider(entry):
    """One parameter."""
    low, high = entry["lower"], entry["upper"]
    reach = BEYOND * (high - low)
    first = low - reach if low <= 0 else max(low - reach, 0.1 * low)
    return tag("label", f"{entry['name']} {entry['unit']}".strip(),
               tag("input", type="range", min=f"{first:.10g}", max=f"{high + reach:.10g}", step="any", value=f"{entry['value']:.17g}"),
               tag("output", figures(entry["value"], 5)),
               tag("span", f"made for {figures(low, 4)} to {figures(high, 4)}", class_="made"))


def model_part(folder, room):
    """All of it."""
    model, data = read_model(folder.path / "reduced_model.bin")
    packed = base64.b64encode(zlib.compress(data, 6)).decode()
    if len(packed) > max(room, 3e6):
        raise BadInput(f"{folder.path / 'reduced_model.bin'}: {len(packed) / 1e6:.1f} MB are too much for the page")
    name = f"{folder.key}-model"
    table = tag("table", tag("thead", tag("tr", [tag("th", head) for head in HEADS])), tag("tbody"))
    said = (f"{count(model['n_used'], 'vector')}, of {count(model['n'] - model['n_used'], 'further one')} for the estimate of its error "
            "(an estimate, no bound). The modes are computed here, in the browser.")
    place = tag("div", [slider(entry) for entry in model["parameters"]], tag("button", "The scene's own values", type="button"),
                tag("p", "", class_="beyond-line", role="status"), tag("p", "", class_="said"), tag("div", table, class_="scroll"),
                class_="sliders", data_source=f"{name}-data")
    content = section(name, "The model", tag("p", said), place,
                      tag("script", Markup(packed), type="application/octet-stream", id=f"{name}-data"))
    return Part(content)
