"""modes_mesh.csv and onsets_mesh.csv: the rows of the scene's own tables with what finer meshes say of each; and both printed."""

import csv
import math
from pathlib import Path

from ..tables import print_table, whole
from .limits import ORDERS

MODE_COLUMNS = ("freq_limit_hz", "error_mesh_hz", "order", "how", "growth_limit_rad_s", "growth_error_mesh_rad_s", "growth_order",
                "growth_how", "shape_share")
ONSET_COLUMNS = "critical_limit", "error_mesh", "order", "how", "freq_limit_hz", "freq_error_mesh_hz"


def text(number):
    """Of a table; empty where there is none."""
    return "" if math.isnan(number) else f"{number:.15g}"


def write_beside(source, path, columns, cells):
    """The table `source` with more columns."""
    with source.open(newline="") as file:
        head, *rows = csv.reader(file)
    with whole(Path(path)) as part, part.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow([*head, *columns])
        table.writerows([*row, *more] for row, more in zip(rows, cells))


def write_modes(path, source, limits):
    """limits: for each mode (Limit of the frequency, of the growth, share of the shape)."""
    write_beside(source, path, MODE_COLUMNS, [
        [*map(text, freq[:3]), freq.how, *map(text, growth[:3]), growth.how, text(share)] for freq, growth, share in limits])


def write_onsets(path, source, limits):
    """limits: for each onset (Limit of the critical value, of the frequency)."""
    write_beside(source, path, ONSET_COLUMNS, [
        [*map(text, value[:3]), value.how, *map(text, freq[:2])] for value, freq in limits])


def short(number, form):
    return "-" if math.isnan(number) else format(number, form)


def order_text(limit):
    """The order, or why there is none."""
    return short(limit.order, ".2f") if limit.how == "observed" else f"{limit.order:g} assumed" if limit.how == "assumed" else limit.how


def print_legend(limits):
    """What the words mean that are there."""
    for how in dict.fromkeys(limit.how for limit in limits if limit.how != "observed"):
        print(f"  {how}: {ORDERS[how]}")


def print_modes(rows, limits):
    """One line for each mode."""
    print_table("error: what the scene's mesh has less what finer meshes tend to", (
        "mode", "freq, Hz", "its algebra", "its mesh", "%", "order", "growth, 1/s", "its mesh", "order", "shape", "label"), *(
        (str(row["mode"]), f"{row['freq_hz']:.3f}", f"{row['error_hz']:.1e}", short(freq.error, ".3g"),
         short(100 * freq.error / row["freq_hz"], ".2g") if row["freq_hz"] > 1 else "-", order_text(freq),
         f"{row['growth_rad_s']:.5g}", short(growth.error, ".3g"), order_text(growth), short(share, ".3f"), row["label"])
        for row, (freq, growth, share) in zip(rows, limits)))
    print_legend([limit for freq, growth, _ in limits for limit in (freq, growth)])


def print_onsets(rows, limits):
    """One line for each onset."""
    print_table("onsets", ("parameter", "value", "its mesh", "%", "order", "freq, Hz", "its mesh", "kind", "label"), *(
        (row["parameter"], f"{row['critical_value']:.6g}", short(value.error, ".3g"),
         short(100 * value.error / row["critical_value"], ".2g") if row["critical_value"] else "-", order_text(value),
         f"{row['freq_hz']:.2f}", short(freq.error, ".3g"), row["kind"], row["label"]) for row, (value, freq) in zip(rows, limits)))
    print_legend([value for value, _ in limits])
