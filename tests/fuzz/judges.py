"""What an input that succeeded says, by readers that share no line with squeal's, and what the run made of it: each judge returns what
is wrong, empty for nothing.

  matrices  the lowest eigenvalues of what oracle.py reads
  affine    eigenvalues of the quadratic problem of the terms, options by PyYAML, matrices by oracle.py
  words     eigenvalues of the matrices that Python reads in the words
  keys      scene.yaml of the run holds each key of the options file with its value, by PyYAML, and no other
  mesh      eigenvalues of a run with the mesh that plain_gmsh.py reads and writes anew"""

import cmath
import math
import re

import numpy as np
import yaml

import oracle
import plain_gmsh

INFINITE = 1e7  # times the lowest |lambda|: beside the inverse square of that one theirs is below rounding, as if there was no mass
OF_RUN = re.compile(r"^output_(dir|fields)$|^model_mesh$|^dynamics_(shape|restart)$|_file$")  # places, which scene.yaml has in full
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$")


def number(text):
    """A number as people write it, nothing else."""
    if not NUMBER.match(text.strip()):
        raise ValueError(f"'{text}' is no number")
    return float(text)


def square(text):
    """A matrix of its rows one after another."""
    values = [number(word) for word in text.split(",")]
    n = math.isqrt(len(values))
    return np.reshape(values, (n, n))


def found_values(found):
    """Eigenvalues of modes.csv."""
    return [complex(s, 2 * math.pi * f) for s, f in zip(found["growth_rad_s"], found["freq_hz"])]


def judge_modes(found, K, M, wanted=3):
    """The lowest |lambda| of M x'' + K x = 0."""
    kappa = np.emath.sqrt(-oracle.eigenvalues(K, M))
    expected = sorted(abs(value) for value in kappa)
    got = [abs(value) for value in found_values(found)]
    floor = 1e-6 * max(expected)
    wanted = min(len(expected), wanted)
    least = min(wanted, sum(value < INFINITE * expected[0] for value in expected)) if expected[0] else 0
    if not least <= len(got) <= wanted:
        return f"{len(got)} modes, not {wanted}: {got} of {expected}"
    off = [(value, other) for value, other in zip(sorted(got), expected) if abs(value - other) > floor + 1e-6 * value]
    return f"eigenvalues {off} are not the lowest of the files: {expected}" if off else ""


def matrices(work, found, words):
    K, M = oracle.read(work / "K.bin"), oracle.read(work / "M.bin")
    return "a file that is no matrix was read" if K is None or M is None else judge_modes(found, K, M)


def quadratic(K, C, M):
    """Finite eigenvalues of lambda^2 M + lambda C + K."""
    n = len(K)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-K, -C]])
    B = np.block([[np.eye(n), np.zeros((n, n))], [np.zeros((n, n)), M]])
    if np.linalg.matrix_rank(M) == n:
        return np.linalg.eigvals(np.linalg.solve(B, A))
    shift = 0.123 + 0.456j
    inverse = np.linalg.eigvals(np.linalg.solve(A - shift * B, B.astype(complex)))
    return shift + 1 / inverse[abs(inverse) > 1e-10 * abs(inverse).max()]


def near(value, others, floor):
    """Whether one of the others is that value, to 1e-6, or to the root of rounding where two are nearly equal."""
    size = max(map(abs, others), default=0)
    first, second = (sorted(abs(value - other) for other in others) + [math.inf, math.inf])[:2]
    rtol = 1e-6 if second > 1e-3 * abs(value) else 1e-4
    return first <= floor + rtol * max(abs(value), 1e-3 * size)


def affine(work, found, words):
    """The sum of terms; each eigenvalue found is one of it, and the nearest to the target is among them."""
    said = {key: value.lower() if key == "terms" or key.endswith("_kind") else value
            for key, value in wanted_keys(work / "affine.yaml").items()}
    K, C, M = (sum((term(work, said, name) for name in said["terms"].split(",") if said[f"{name}_kind"] == kind), np.zeros((1, 1)))
               for kind in ("stiffness", "damping", "mass"))
    expected = [value for value in quadratic(K, C, M) if value.imag >= -1e-9 * abs(value)]
    target = 2j * math.pi * number(said.get("modes_target", "0"))
    got, size = found_values(found), max(map(abs, expected))
    errors = [2 * 2 * math.pi * error for error in found["error_hz"]]  # twice what is stated: an estimate
    strange = [value for value, error in zip(got, errors) if not near(value, expected, max(error, 1e-9 * size))]
    if strange:
        return f"{strange} are no eigenvalues of the terms: {expected}"
    first = min(expected, key=lambda value: abs(value - target))
    least = min((abs(value - target) for value in got), default=math.inf)
    wrong = least > abs(first - target) * (1 + 1e-3) + 1e-6 * size
    return f"{first} is nearest, and not found: {got}" if wrong else ""


def term(work, said, name):
    """One matrix, times its factors."""
    A = square(said[f"{name}_dense"]) if f"{name}_dense" in said else oracle.read(work / said[f"{name}_file"])
    if A is None:
        raise ValueError(f"{name}: no matrix")
    factor = number(said.get(f"{name}_scale", "1"))
    parameters = [word for word in said.get(f"{name}_parameter", "").split(",") if word.strip()]
    powers = said.get(f"{name}_power", ",".join("1" * len(parameters))).split(",")
    for parameter, power in zip(parameters, powers):
        factor *= number(said[parameter.strip().lower()]) ** int(power)
    return factor * A


def words(work, found, words):
    """Of the command line alone."""
    words = [word.decode() if isinstance(word, bytes) else word for word in words]
    said = dict(zip(map(str.lower, words[::2]), words[1::2]))  # as PETSc takes names
    K, M, H = (square(said[f"-operators_dense_{name}"]) for name in "kmh")
    count, target = int(number(said["-modes_count"])), number(said["-modes_target"])
    if str(count) != said["-modes_count"].strip().lstrip("+"):
        return f"a count of '{said['-modes_count']}' was taken"
    for name in ("-modes_growth", "-eps_tol"):
        number(said[name])
    K = K + number(said["-contact_mu"]) * H
    if target == 0:
        return judge_modes(found, K, M, count)
    expected = [value for root in np.emath.sqrt(-oracle.eigenvalues(K, M).astype(complex)) for value in (root, -root)]
    strange = [value for value in found_values(found) if not near(value, expected, 1e-6 * max(map(abs, expected)))]
    return f"{strange} are no eigenvalues of the words: {expected}" if strange else ""


def flat(node, prefix=""):
    """Keys and scalars of a tree of PyYAML's, joined by underscores, in small letters, as PETSc takes names; lists by commas."""
    if isinstance(node, dict):
        for key, value in node.items():
            yield from flat(value, f"{prefix}_{key}".lower() if prefix else str(key).lower())
    else:
        yield prefix, ",".join(map(str, node)) if isinstance(node, list) else str(node)


def wanted_keys(path):
    """Options of a file, as PyYAML reads its text, behind marks that it may begin with."""
    text = path.read_bytes().decode().lstrip("\ufeff\u2028")
    return dict(flat(yaml.load(text, yaml.BaseLoader)))


def plain(value):
    """Of a value: blanks at commas do not count."""
    return re.sub(r"\s*,\s*", ",", value.strip())


def keys(work, words):
    """Of every run by an options file."""
    names = dict(zip(words[::2], words[1::2]))
    given = wanted_keys(work / names.pop("-options_file"))
    given |= {name.lstrip("-"): value for name, value in names.items()}
    ran = wanted_keys(work / "out/scene.yaml")
    given, ran = ({key: value for key, value in of.items() if not OF_RUN.search(key)} for of in (given, ran))
    lost = [f"{key}: {value!r}" for key, value in given.items() if plain(ran.pop(key, "(nothing)")) != plain(value)]
    return f"{lost} of the file is not what was run" if lost else f"{ran} was run and is not in the file" if ran else ""


def mesh(work, found, words, again):
    """The same modes of the mesh as it was read here; `again` runs with it and returns its table, or what went wrong."""
    name = dict(zip(words[::2], words[1::2]))["-model_mesh"]
    (work / "plain.msh").write_text(plain_gmsh.rewrite((work / name).read_bytes()), encoding="latin-1")
    other = again("plain.msh")
    if isinstance(other, str):
        return f"the same mesh written anew is refused: {other}"
    got, expected = (sorted(map(abs, map(complex, found_values(table)))) for table in (found, other))
    same = len(got) == len(expected) and all(cmath.isclose(a, b, rel_tol=1e-7, abs_tol=1e-6 * max(expected)) for a, b in zip(got, expected))
    return "" if same else f"{got} of the file, {expected} of the same mesh written anew"
