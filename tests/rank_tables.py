"""Tables of two runs of one scene, which may differ by rounding alone: what differs more, in words."""

import csv
import math

SAME = 1e-9  # of the largest number of a column
GROWN = 1e3  # times what the last digit of a density has changed on one rank up to a row
ROWS = 3  # times as many as that has added or taken
# Columns that share a unit, and so a scale, as parts of multipliers do; longer ones before their ends
UNITS = "_percent", "_w_m2", "_w", "_m_ns", "_m_n", "_m_s2", "_rad_s", "_j", "_n", "_pa", "_m_s", "_m"
# In names of columns that tell what rounding leaves
ESTIMATES = "error", "condition", "damping_ratio", "check", "residual", "period_slope", "worst_ratio", "sweeps", "pairs_changed", \
    "steps_changed", "onset_distance"
# A column with the one that states its error
VALUES = {"onsets.csv": ("critical_value", "error_estimate"), "modes_causes.csv": ("growth_rad_s", "error_rad_s"),
          "modes_effects.csv": ("growth_rad_s_per_unit", "error_rad_s_per_unit"), "modes_feed_in.csv": ("friction_w", "error_w"),
          "modes_sensitivities.csv": ("growth_rad_s_per_percent", "error_rad_s_per_percent"),
          "modes_components.csv": ("share_percent", "error_percent")}
# Columns that have no error of their own: of nodes that are nearly as good another may be named
FOLLOW = {"modes_effects.csv": {*(f"{axis}_m" for axis in "xyz"), *(f"direction_{axis}" for axis in "xyz"), "freq_hz_per_unit",
                                "first_order_units_to_zero", *(f"to_{axis}_m" for axis in "xyz")},
          "modes_components.csv": {"energy_percent"}, "modes_changed.csv": {"before", "overlap"}, "modes_causes.csv": {"power_w"},
          "modes_feed_in.csv": {"friction_damping_w", "falling_friction_w", "power_w_m2"},
          "modes_sensitivities.csv": {"freq_hz_per_unit", "growth_rad_s_per_unit", "freq_hz_per_percent"}}


def read(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def eigenvalue(row):
    return complex(float(row["growth_rad_s"]), 2 * math.pi * float(row["freq_hz"]))


def stated(row):
    """Error that a row states of its eigenvalue, rad/s."""
    error = 2 * math.pi * float(row.get("error_hz") or 0)
    return error if math.isfinite(error) else 0


def of_condition(row, left):
    """Error of the eigenvalue of a row without left vectors, rad/s: the condition of the row with them times its own backward error."""
    own, known = float(row["backward_error"]), float(left["backward_error"])
    return stated(left) * max(1, own / known) if known > 0 else stated(left)


def apart(x, y):
    """Difference of two fields; none where they are the same, infinite where one is no number."""
    if x == y:
        return 0
    x, y = number(x), number(y)
    if x is None or y is None:
        return math.inf
    return 0 if math.isnan(x) and math.isnan(y) else abs(x - y) if math.isfinite(x - y) else math.inf


class Comparison:
    """Differences of the rows of one table; `digit` has those of one rank with another last digit, `left` those with left vectors."""

    def __init__(self, name, one, other, digit=None, left=None):
        self.name, self.one, self.other = name, one, other
        self.left = left if left and len(left) == len(one) and name == "modes.csv" else None
        self.found, self.worst, self.first = [], 0.0, len(one)
        self.columns = [column for column in (one[0] if one else ()) if not any(word in column for word in ESTIMATES)]
        self.grown = self.growth(digit) if digit is not None else [0] * len(one)
        self.rows = ROWS * abs(len(digit) - len(one)) if digit else 0

    def growth(self, digit):
        """How far the run with another digit has come from the first one up to each row, of the largest numbers; a row that it lacks
        says nothing."""
        largest, grown = 0, []
        for i, row in enumerate(self.one):
            changes = [apart(row[column], digit[i].get(column)) / self.scale(column) for column in self.columns] if i < len(digit) else []
            largest = max([largest, *changes])
            grown.append(largest)
        return grown if self.columns and "time_s" in self.columns else [largest] * len(grown)

    def scale(self, column):
        """The largest number of all columns of its unit."""
        unit = next((unit for unit in UNITS if column.endswith(unit)), column)
        names = [name for name in self.one[0] if name.endswith(unit) or "multiplier_" in name and "multiplier_" in column]
        values = (number(row[name]) for row in self.one for name in names)
        return max((abs(v) for v in values if v is not None and math.isfinite(v)), default=0) or 1

    def say(self, i, text, size):
        """A difference in a row, which is one of the size."""
        if size > max(SAME, GROWN * self.grown[i]):
            self.found.append(f"{self.name} row {i + 1}: {text}")
        elif size > SAME:
            self.first = min(self.first, i)
        else:
            self.worst = max(self.worst, size)

    def values(self, column):
        """A column in rows that both runs have in this order."""
        scale = self.scale(column)
        for i, (p, q) in enumerate(zip(self.one, self.other)):
            self.say(i, f"{column} '{p[column]}' '{q[column]}', scale {scale:.3g}", apart(p[column], q[column]) / scale)

    def eigenvalues(self):
        for i, (p, q) in enumerate(zip(self.one, self.other)):
            x, y, errors = eigenvalue(p), eigenvalue(q), [stated(p), stated(q)]
            if self.left:
                errors = [of_condition(row, self.left[i]) for row in (p, q)]
            allowed = max(sum(errors), 1e-6)
            size = 0 if abs(x - y) <= allowed else abs(x - y) / abs(x) if x else math.inf
            self.say(i, f"{x:.12g} and {y:.12g} rad/s, which state {errors[0]:.2g} and {errors[1]:.2g}", size)

    def stated_values(self, column, error):
        """A column with its errors."""
        for i, (p, q) in enumerate(zip(self.one, self.other)):
            x, y, allowed = float(p[column]), float(q[column]), float(p[error] or 0) + float(q[error] or 0)
            if not math.isfinite(allowed):
                continue  # without left vectors no error is known
            size = 0 if abs(x - y) <= allowed else abs(x - y) / (abs(x) or 1)
            self.say(i, f"{column} {x:.15g} and {y:.15g}, which state {allowed:.2g}", size)

    def compare(self):
        if self.one and self.other and list(self.one[0]) != list(self.other[0]):
            self.found.append(f"{self.name}: other columns")
            return self
        if abs(len(self.one) - len(self.other)) > self.rows:
            self.found.append(f"{self.name}: {len(self.one)} and {len(self.other)} rows")
            return self
        columns = set(self.columns)
        if self.name in ("modes.csv", "sweep.csv"):
            self.eigenvalues()
            columns -= {"growth_rad_s", "freq_hz"}
        if self.name in VALUES:
            self.stated_values(*VALUES[self.name])
            columns -= {VALUES[self.name][0], "freq_hz"}
        columns -= FOLLOW.get(self.name, set())
        for column in self.columns:
            if column in columns:
                self.values(column)
        return self


def compared(one, other, digit=None, left=None):
    """Comparisons of the tables of two folders, beside those with another digit and with left vectors, and the names of tables that one
    of the two lacks."""
    names = sorted({path.name for folder in (one, other) for path in folder.glob("*.csv")})
    missing = [f"no {name} in one" for name in names if not ((one / name).exists() and (other / name).exists())]
    both = [name for name in names if (one / name).exists() and (other / name).exists()]
    third, fourth = ({name: read(more / name) for name in both if (more / name).exists()} if more else {} for more in (digit, left))
    return [Comparison(name, read(one / name), read(other / name), third.get(name), fourth.get(name)).compare() for name in both], missing
