"""Random scenes of each analysis that run in a blink: those of random_scenes.py on coarse meshes, and systems of random matrices."""

import random

from random_scenes import MASSI, ONLY_MODES, SWEPT, Scene

TIME = {"modes_contact", "static_geometric", "contact_kt", "contact_friction_damping", "contact_mu_slope", "contact_force", "disc_spin",
        "disc_spin_axis", "disc_spin_centre", "contact_law", "contact_kn", "modes_band", "operators_mass", "pad_loss_factor",
        "model_loss_frequency", "contact_speed"}


class Small(Scene):
    """A scene on a mesh of some ten to hundred nodes."""

    def rig(self):
        pad, beam = self.draw.choice((1, 1, 2, 3)), self.draw.choice((3, 3, 4, 5))
        rings, columns, mesh = pad + self.draw.choice((2, 3)), pad + self.draw.choice((4, 5, 8)), "patch"
        if self.happens(0.5):
            rings, columns, mesh = self.draw.choice((2, 3)), self.draw.choice((6, 8, 12)), "axisymmetric"
        self.text += (f'rig: {{disc: {{mesh: {mesh}, elements: "{rings},{columns},1"}}, '
                      f'pad: {{elements: "{pad},{pad},{self.draw.choice((1, 2))}"}}, beam: {{elements: {beam}}}}}\n')

    def words(self, without=()):
        """A disc that spins is round."""
        spins = "disc_spin" in self.options and "disc_spin" not in without
        return super().words(without) + (["-rig_disc_mesh", "axisymmetric", "-rig_disc_elements", "2,16,1"] if spins else [])


def modes(scene):
    """All modes of a band, or the nearest to a frequency, by any route."""
    draw, more = scene.draw, []
    if scene.happens(0.25):
        more += ["-modes_target", draw.choice((10, 2000, 7000)), "-modes_count", draw.choice((1, 4, 9))]
        scene.options.pop("modes_band")
    elif scene.happens(0.2) and not scene.damped and not scene.mu:
        more += ["-modes_shifts", draw.choice((2, 3))]
    if scene.happens(0.2):
        more += ["-modes_left", "0"]
    if scene.happens(0.2) and scene.damped:
        more += ["-modes_damping", draw.choice(("pep", "project"))]
    if "-modes_left" not in more and scene.happens(0.3):
        more += ["-modes_sensitivities"]
    if scene.happens(0.3):
        more += draw.choice((["-modes_components", 0.8], ["-modes_components", 1.5], ["-modes_components_found", "true"]))
    return scene.words() + more


def sweep(scene):
    """Over one parameter or two, by a basis or in full."""
    draw, names = scene.draw, [scene.swept()]
    other = scene.swept()
    names += [other] if other != names[0] and scene.happens(0.4) else []
    more = ["-sweep_parameter", ",".join(names), "-sweep_values", SWEPT[names[0]]]
    more += ["-sweep_values_2", SWEPT[names[1]].replace(":4", ":2")] if len(names) > 1 else []
    more += draw.choice(([], [], ["-sweep_method", "full"], ["-sweep_verify", "2"], ["-sweep_sensitivities"], ["-sweep_onsets", "0"]))
    if any(name in scene.options for name in ("contact_kt", "contact_law")) and "full" not in more and scene.happens(0.3):
        more += ["-sweep_method", "full"]
    return scene.words() + more


def static(scene):
    """With pairs that stick, slip and open, in steps, by both ways."""
    draw = scene.draw
    if scene.happens(0.4):
        scene.options["contact_slip"] = "0,0,0"
    more = ["-press_force", f"{draw.choice((0, 0, 3, -8))},{draw.choice((0, 0, 5, -60))},{-draw.uniform(20, 200):.4g}"]
    more += ["-static_dense", "1"] if scene.happens(0.3) else []
    more += ["-static_load_steps", draw.choice((2, 3))] if scene.happens(0.3) else []
    more += ["-model_gravity", "0,3,-9.81"] if scene.happens(0.3) else []
    without = ONLY_MODES | {"model_gravity"}
    if "contact_kn" in scene.options and "-static_dense" not in more and scene.happens(0.5):
        without |= {"contact_kn"}
        more += draw.choice((["-contact_pressure_law", "exponential", "-contact_pressure_c0", scene.power(-8, -5),
                              "-contact_pressure_p0", scene.power(3, 8)],
                             ["-contact_pressure_law", "power", "-contact_pressure_k", scene.power(16, 20)],
                             ["-contact_pressure_law", "table", "-contact_pressure_table", "-1e-6,0,0,1e4,1e-6,1e6,3e-6,1e8"]))
    if scene.options.get("contact_slip") != "0,0,0" and scene.happens(0.3):
        more += ["-contact_speed", "1", "-contact_wear_rate", scene.power(-15, -12), "-contact_wear_exponent",
                 draw.choice(("1", "0.8", "1.1")), "-wear_time", "1000", "-wear_steps", "6"]
    return scene.words(without=without) + more


def frf(scene):
    """By superposition or directly, with an answer to an impulse."""
    draw = scene.draw
    frequencies = ",".join(f"{f:.6g}" for f in sorted(draw.uniform(scene.band[0] + 50, scene.band[1]) for _ in range(3)))
    more = ["-probes", "top,edge", "-top_at", "0.11,0,0.1", "-edge_at", "-0.12,0,0", "-edge_part", "disc", "-frf_force",
            draw.choice(("top,y", "edge,z", "top,0.6,0,0.8")), "-frf_frequencies", draw.choice((frequencies, "100:3000:9"))]
    more += draw.choice(([], [], ["-frf_method", "direct"], ["-frf_times", "0:0.002:5"]))
    return scene.words() + more


def in_time(scene):
    """Words of a run in time."""
    draw = scene.draw
    speed = f"{draw.choice((0.05, 0.5, 2)):g}"
    more = ["-contact_law", "constraint", "-dynamics_live", "0", "-contact_speed", speed, "-impulses", "tap", "-tap_at", "-0.12,0,0",
            "-tap_part", "disc", "-tap_impulse", f"0,0,{draw.uniform(-2e-4, 2e-4):.4g}"]
    if scene.options.get("contact_slip") == "0,0,0":
        more[4:6] = []
    for part in ("disc", "pad", "beam"):
        if scene.happens(0.5) and not scene.damped:
            more += [f"-{part}_alpha", f"{draw.uniform(0, 300):.4g}"]
    return scene.words(without=TIME) + more


def starting(scene, static):
    """At rest with a ramp, or from the sliding state."""
    return ["-dynamics_start", "static"] if static or scene.happens(0.5) else ["-press_ramp", "1e-4"] if scene.happens(0.6) else []


def transient(scene):
    """On the mesh."""
    draw = scene.draw
    more = starting(scene, False) + ["-ts_max_time", scene.power(-5.5, -3.8), "-probes", "edge,top", "-edge_at", "-0.12,0,0",
                                     "-top_at", "0.11,0,0.1", "-dynamics_history_interval", "1e-6"]
    more += ["-dynamics_pairs_interval", "1e-6"] if scene.happens(0.4) else []
    more += ["-ts_central_b", f"{draw.uniform(0.5, 1):.3g}"] if scene.happens(0.2) and "points" not in scene.text else []
    return in_time(scene) + more


def reduced(scene):
    """On the modes of the bodies."""
    more = starting(scene, False) + ["-dynamics_model", "reduced", "-dynamics_cutoff", scene.draw.choice((8e3, 15e3, 30e3)),
                                     "-ts_max_time", scene.power(-4, -2.5), "-probes", "edge", "-edge_at", "-0.12,0,0",
                                     "-dynamics_history_interval", "1e-5"]
    more += ["-dynamics_verify"] if scene.happens(0.15) else []
    more += ["-modes_band", "500,4000"] if scene.happens(0.3) else ["-dynamics_compare", "false"]
    return in_time(scene) + more


def vibration_map(scene):
    """Few points of few windows."""
    scene.mu = scene.options["contact_mu"] = scene.mu or 0.4
    if scene.options.get("contact_slip") == "0,0,0":
        scene.options["contact_slip"] = "0,1,0"
    draw = scene.draw
    names, values = draw.choice((("contact_mu", "0.1,0.5"), ("press_force", "60,150"), ("contact_mu,press_force", "0.2,0.4,0.6"),
                                 ("pad_young", "1e10,3e10")))
    more = ["-map_parameter", names, "-map_values", values, *(["-map_values_2", "50,100"] if "," in names else [])]
    more += ["-map_direction", draw.choice(("both", "up", "down", "apart")), "-map_window", "7e-4", "-ts_max_time", "5.6e-3",
             "-dynamics_model", "reduced", "-dynamics_cutoff", draw.choice((8e3, 12e3))]
    more += ["-map_verify", "1"] if scene.happens(0.2) else []
    words = in_time(scene)
    at = words.index("-dynamics_live")
    return words[:at] + words[at + 2:] + more


def cycle(scene):
    """From the onset of a mode, or from a transient, of the brake that has one."""
    draw = scene.draw
    scene.text = (f'rig: {{disc: {{elements: "{draw.choice((4, 5, 6))},{draw.choice((16, 20, 24))},1"}}, '
                  f'pad: {{elements: "2,2,{draw.choice((1, 2))}"}}, beam: {{elements: {draw.choice((3, 4, 6))}}}}}\n')
    words = ["-contact_law", "constraint", "-contact_speed", "2", "-contact_mu", f"{draw.uniform(0.3, 0.7):.3g}", "-ts_dt", "8e-6",
             "-dynamics_model", "reduced", "-dynamics_compare", "false", "-dynamics_cutoff", draw.choice((12e3, 20e3)), "-cycle_verify",
             draw.choice(("false", "true")), "-pad_young", f"{draw.uniform(8e9, 4e10):.4g}"]
    for part in ("disc", "pad", "beam"):
        words += [f"-{part}_alpha", f"{draw.choice((30, 100, 300))}", f"-{part}_beta", "2e-7"]
    if scene.happens(0.6):
        words += ["-cycle_start", "mode", "-cycle_parameter", "contact_mu", "-cycle_range", "0.02,1.2", "-cycle_points", "3"]
    else:
        words += ["-ts_max_time", "30e-3", "-dynamics_live", "0", "-press_ramp", "1e-3", "-cycle_steps", "25"]
        words += ["-cycle_parameter", "pad_young", "-cycle_range", "5e9,5e10", "-cycle_points", "2"] if scene.happens(0.3) else []
    return words


def entries(draw, n, share, symmetric=0):
    """A matrix of n x n as rows: each entry off the diagonal there with a probability; 1 makes it symmetric, -1 skew."""
    a = [[draw.uniform(-1, 1) if draw.random() < share else 0.0 for _ in range(n)] for _ in range(n)]
    for i in range(n):
        a[i][i] = 0.0
        for j in range(i):
            a[i][j] = symmetric * a[j][i] if symmetric else a[i][j]
    return a


def plus(a, diagonal):
    return [[value + (diagonal[i] if i == j else 0) for j, value in enumerate(row)] for i, row in enumerate(a)]


def inline(a):
    return ",".join(f"{value:.12g}" for row in a for value in row)


def matrices(draw):
    """Options file and words: K, M, and C or H where it happens so, of one unknown to forty, or terms with a parameter."""
    n, share = draw.choice((1, 2, 3, 4, 6, 9, 17, 40)), draw.choice((0, 0.1, 0.5, 1))
    equal = draw.random() < 0.2  # several unknowns alike
    size = n * share + 1
    K = plus(entries(draw, n, share, 1), [2 * size + (0 if equal else draw.uniform(0, 4 * size)) for _ in range(n)])
    M = plus(entries(draw, n, draw.choice((0, share)), 1), [size * (1 if equal else draw.uniform(1, 2)) for _ in range(n)])
    C = plus(entries(draw, n, draw.choice((0, share)), draw.choice((1, 1, -1, 0))), [size * draw.choice((0, 0.01, 0.3))] * n)
    H = entries(draw, n, draw.choice((0, share)), 0)
    band = ["-modes_band", draw.choice(("0,1", "0.1,0.6")), "-modes_growth", "10"]
    lines = [f"operators_dense_k: \"{inline(K)}\"", f"operators_dense_m: \"{inline(M)}\""]
    if draw.random() < 0.5:
        lines += [f"operators_dense_c: \"{inline(C)}\""] if draw.random() < 0.5 else []
        lines += [f"operators_dense_h: \"{inline(H)}\""] if draw.random() < 0.4 else []
        band += ["-contact_mu", "0.7"] if "dense_h" in lines[-1] else []
        return "\n".join(lines) + "\n", band
    names = ["m", "k", "c", "h"][:draw.choice((2, 3, 4))]
    lines = [f"terms: \"{','.join(names)}\"", *(["speed: 2"] if len(names) > 2 else [])]
    for name, a, kind in zip(names, (M, K, C, H), ("mass", "stiffness", "damping", "stiffness")):
        swept = f", parameter: speed, power: {draw.choice((-1, 1, 2))}" if name in "ch" else ""
        lines.append(f'{name}: {{kind: {kind}, dense: "{inline(a)}"{swept}}}')
    if len(names) > 2 and draw.random() < 0.6:
        band += ["-analysis", "sweep", "-sweep_parameter", "speed", "-sweep_values", "1:3:5"]
        band += draw.choice(([], ["-sweep_method", "full"]))
    return "\n".join(lines) + "\n", band


def free(draw):
    """A ring that hangs on nothing, at rest or spinning."""
    words = ["-rig_disc_elements", f"{draw.choice((1, 2, 3))},{draw.choice((12, 16, 24))},{draw.choice((1, 2))}", "-modes_band",
             f"{draw.choice((0, 0, 50))},{draw.choice((400, 1500, 5000))}"]
    if draw.random() < 0.5 and int(words[1].split(",")[1]) > 12:
        words += ["-disc_spin", f"{draw.uniform(-90, 90):.4g}", "-disc_spin_axis", "0,0,1", "-disc_spin_centre", "0,0,0"]
    if draw.random() < 0.3:
        words += ["-disc_alpha", f"{draw.uniform(0, 20):.3g}", "-disc_beta", "1e-8"]
    return words


BRAKES = {"modes": ("modes", modes), "sweep": ("sweep", sweep), "static": ("static", static), "frf": ("frf", frf),
          "transient": ("transient", transient), "reduced": ("transient", reduced), "map": ("map", vibration_map),
          "cycle": ("cycle", cycle)}
KINDS = (*BRAKES, "matrices", "free")
IN_TIME = "transient", "reduced", "map", "cycle"


def scene_of(kind, seed):
    """Text of the scene's own file, and the words of its run."""
    draw = random.Random(f"{kind} {seed}")
    if kind == "matrices":
        text, words = matrices(draw)
    elif kind == "free":
        text, words = "", ["-options_file", MASSI.with_name("free_ring.yaml"), *free(draw)]
    else:
        scene = Small(f"{kind} {seed}")
        analysis, words = BRAKES[kind]
        words = words(scene)
        text, words = scene.text, ["-options_file", MASSI, "-options_file", "scene.yaml", "-analysis", analysis, *words]
    return text, [str(word) for word in (words if text == "" or kind != "matrices" else ["-options_file", "scene.yaml", *words])]
