"""What the page of scripts/report says of maps of vibration and limit cycles, against their tables. Used by test_report.py."""

import numpy

from report_checks import rows_of


def check_vibrations(t, page, keys, folders):
    """Maps of vibration and limit cycles: breaks when columns are mixed up or there is no picture."""
    columns = ({"contact_mu": "value", "press_force, N": "value_2", "main line, Hz": "freq_hz",
                "rms of the force, N": "force_rms_n", "growth, 1/s": "growth_rad_s"},
               {"contact_mu": "value", "freq, Hz": "freq_hz", "rms of the force, N": "force_rms_n",
                "largest force, N": "force_peak_n", "largest multiplier": "multiplier_abs"})
    for key, folder, file, name, shown in zip(keys, folders, ("map.csv", "cycle.csv"), ("points", "cycles"), columns):
        rows, cells = rows_of(folder / file), page.table(f"{key}-{name}")
        t.check(len(cells) == len(rows) > 2, f"{key}: {len(cells)} rows of {file}")
        for title, column in shown.items():
            values = [(float(cell[title]), float(row[column])) for cell, row in zip(cells, rows)]
            t.check(all(a == b or numpy.isnan([a, b]).all() for a, b in values), f"{key}: {title}")
        image = page.find("img", inside=f"{key}-{file[:-4]}")
        t.check(image and image[0]["src"].startswith("data:image/png;base64,iVBOR"), f"{key}: a picture of {file}")
