#!/usr/bin/env python3
"""What scripts/export writes, read by others:

  vtu       every element, and two in one mesh: VTK's reader of VTU sees the points, cells, parts and shapes that VTK's
            reader of HDF sees in the file of the program; the same of pieces, put together; lists name what is there
  series    shapes with an imaginary part, filters, a sliding state and snapshots, with numbers as in the tables
  unv       the mesh, read by gmsh, gives the frequencies of the run to 1e-9; shapes read by columns to six digits
  matrices  read by scipy they are those of the run to the last bit, and LAPACK finds its frequencies; the loads sum up; brought
            back by scripts/import_matrices they have the same modes within their errors
  bad       no folder, no fields, damaged files, no place to write: one line, status 1, no file of a final name

Breaks when an order of nodes is another one, a field is lost or stands under another name, or a file is half written.

    test_export.py SQUEAL MPIRUN"""

import csv
import re
import shutil
import sys
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

import h5py
import numpy as np
from forked import run_command
from served import sooner
from small_brake import SCENE
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader

SOURCE = Path(__file__).resolve().parents[1]
EXPORT = SOURCE / "scripts/export"
SOLIDS = ["tet4", "tet10", "wedge6", "wedge15", "hex8", "hex20", "hex27", "hex+wedge2", "wedge+tet1"]
BAR = "-parts bar -bar_young 210e9 -bar_density 7800 -bar_poisson 0.3 -modes_band 0,60000".split()
FAULTS = []


def check(holds, what):
    print("ok  " if holds else "FAIL", what)
    if not holds:
        FAULTS.append(what)


def run(*words):
    """Output of a command that must succeed."""
    done = run_command(words)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


def squeal(*words):
    return run(sys.argv[2], "-n", 1, sys.argv[1], *words)


def modes_of(folder):
    with (folder / "modes.csv").open(newline="") as lines:
        return list(csv.DictReader(lines))


def grid_of(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def arrays_of(data):
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())
            if data.GetArray(i)}


def cells_of(grid):
    """Type, part, and places of the nodes of each cell, in order."""
    points, part = vtk_to_numpy(grid.GetPoints().GetData()), arrays_of(grid.GetCellData())["part"]
    nodes = [[grid.GetCell(k).GetPointId(i) for i in range(grid.GetCell(k).GetNumberOfPoints())] for k in range(len(part))]
    return [(grid.GetCellType(k), int(part[k]), points[row].tobytes()) for k, row in enumerate(nodes)]


def by_place(grid, name):
    """Values of an array by place; every node of the mesh is in some piece."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    return {point.tobytes(): value.tobytes() for point, value in zip(points, arrays_of(grid.GetPointData())[name])}


def check_vtu(folder):
    """One run of a box: every mode, whole and in three pieces."""
    run(EXPORT, "vtu", folder)
    run(EXPORT, "vtu", folder, "--pieces", 3, "-o", folder / "pieces")
    theirs = grid_of(vtkHDFReader(), folder / "modes.h5")
    wanted, shapes = cells_of(theirs), arrays_of(theirs.GetPointData())
    same = True
    rows = modes_of(folder)
    for row in rows:
        name = f"modes_{int(row['mode']):03d}"
        ours = grid_of(vtkXMLUnstructuredGridReader(), folder / f"vtu/{name}.vtu")
        same &= cells_of(ours) == wanted and ours.GetNumberOfPoints() == theirs.GetNumberOfPoints()
        for part in ("re", "im"):
            found = arrays_of(ours.GetPointData())[f"displacement_{part}"]
            same &= np.array_equal(found, shapes[f"mode_{int(row['mode']):03d}_{part}"])
        same &= arrays_of(ours.GetFieldData())["freq_hz"][0] == float(row["freq_hz"])
    cut = grid_of(vtkXMLPUnstructuredGridReader(), folder / "pieces/modes_007.pvtu")
    whole = grid_of(vtkXMLUnstructuredGridReader(), folder / "vtu/modes_007.vtu")
    same_cut = cells_of(cut) == wanted and by_place(cut, "displacement_re") == by_place(whole, "displacement_re")
    check(same and len(rows) > 6, f"vtu: {folder.name}, {len(wanted)} cells, {len(rows)} modes as in modes.h5")
    check(same_cut, f"vtu: {folder.name} in three pieces")


def datasets(path):
    """(number, lines) of each dataset of a universal file."""
    text = path.read_text().splitlines()
    marks = [i for i, line in enumerate(text) if line == "    -1"]
    return [(int(text[a + 1]), text[a + 2:b]) for a, b in zip(marks[::2], marks[1::2])]


def columns(line, width):
    return [float(line[k:k + width]) for k in range(0, len(line), width)]


def read_55(lines):
    """Head, integers, reals and values [n][numbers] of a field; nodes must be numbered from 1."""
    assert [int(line) for line in lines[8::2]] == list(range(1, len(lines[8::2]) + 1))
    values = np.array([columns(line, 13) for line in lines[9::2]])
    return [int(v) for v in columns(lines[5], 10)], [int(v) for v in columns(lines[6], 10)], columns(lines[7], 13), values


def near(found, wanted):
    """Six digits."""
    return found.shape == wanted.shape and (abs(found - wanted) <= 1e-5 * abs(wanted) + 1e-98).all()


def check_unv(folder):
    """One run of a box: gmsh's reading of its mesh, and the shapes."""
    run(EXPORT, "unv", folder)
    found = datasets(folder / "fields.unv")
    shapes, rows = [read_55(lines) for number, lines in found if number == 55], modes_of(folder)
    with h5py.File(folder / "modes.h5") as file:
        data = file["VTKHDF/PointData"]
        same = all(near(shape[3], data[f"mode_{k:03d}_re"][:]) for k, shape in enumerate(shapes, 1))
    heads = all(head == [1, 2, 2, 8, 2, 3] and whole[3] == k for k, (head, whole, _, _) in enumerate(shapes, 1))
    check(same and heads and len(shapes) == len(rows), f"unv: {folder.name}, {len(shapes)} shapes")
    if folder.name == "hex27" or not shutil.which("gmsh"):
        return
    run("gmsh", "-0", folder / "fields.unv", "-format", "msh22", "-o", folder / "back.msh")
    text = (folder / "back.msh").read_text()
    (folder / "back.msh").write_text(text.replace("$Nodes", '$PhysicalNames\n1\n3 1 "bar"\n$EndPhysicalNames\n$Nodes', 1))
    squeal(*BAR, "-model_mesh", folder / "back.msh", "-output_dir", folder / "back", "-output_fields", 0)
    pairs = [(float(a["freq_hz"]), float(b["freq_hz"])) for a, b in zip(rows, modes_of(folder / "back"))]
    worst = max(abs(a - b) / max(a, 1) for a, b in pairs)
    check(len(pairs) == len(rows) and worst < 1e-9, f"unv: {folder.name} by gmsh has the same frequencies, apart by {worst:.1e}")


def check_series(top):
    """A brake: complex modes, filters, sliding state, snapshots."""
    (top / "matrices").mkdir()
    (top / "matrices/C.bin").touch()  # of an earlier run, which had damping
    squeal("-options_file", top / "scene.yaml", "-modes_band", "500,9000", "-modes_filters", 1, "-output_dir", top / "m",
           "-operators_save", top / "matrices")
    squeal("-options_file", top / "scene.yaml", "-analysis", "static", "-output_dir", top / "s")
    squeal("-options_file", top / "scene.yaml", "-analysis", "transient", "-ts_max_time", 2e-5, "-dynamics_snapshot_interval",
           1e-5, "-output_dir", top / "t")
    for name, series, file in (("m", "modes", "modes.h5"), ("m", "filters", "filters.h5"), ("s", "static", "static.h5"),
                               ("t", "transient", "snapshot_000001.h5")):
        run(EXPORT, "vtu", top / name)
        listed = [(float(row.get("timestep")), top / name / "vtu" / row.get("file"))
                  for row in xml.parse(top / f"{name}/vtu/{series}.pvd").iter("DataSet")]
        count = {"m": len(modes_of(top / "m")), "s": 1, "t": 3}[name]
        check(len(listed) == count and all(path.is_file() for _, path in listed), f"series: {series}.pvd lists {count}")
        value, path = listed[1 if name == "t" else 0]
        ours, theirs = grid_of(vtkXMLUnstructuredGridReader(), path), grid_of(vtkHDFReader(), top / name / file)
        pattern = re.compile(r"mode_001_(.*)" if name == "m" else r"(.*)")
        wanted = {pattern.fullmatch(key)[1]: array for key, array in arrays_of(theirs.GetPointData()).items() if pattern.fullmatch(key)}
        prefix = {"modes": "displacement_", "filters": "filter_"}.get(series, "")
        found = arrays_of(ours.GetPointData())
        wanted = {key if key == "feed_in_w_m2" else prefix + key: array for key, array in wanted.items()}
        same = set(wanted) == set(found) and all(np.array_equal(found[key], array) for key, array in wanted.items())
        check(same, f"series: {series} has {', '.join(sorted(found))}")
    row = modes_of(top / "m")[-1]
    last = arrays_of(grid_of(vtkXMLUnstructuredGridReader(), top / f"m/vtu/modes_{int(row['mode']):03d}.vtu").GetFieldData())
    check(last["growth_rad_s"][0] == float(row["growth_rad_s"]), "series: growth is that of modes.csv")
    times = [float(text) for text in re.findall(r'<Time Value="([^"]*)"', (top / "t/transient.xmf").read_text())]
    check([value for value, _ in listed] == times and times[-1] > 0, f"series: snapshots at {times} s")
    run(EXPORT, "unv", top / "m")
    fields = [read_55(lines) for number, lines in datasets(top / "m/fields.unv") if number == 55]
    shapes, powers = ([field for field in fields if field[0][2] == kind] for kind in (2, 1))
    grown = max(range(len(modes_of(top / "m"))), key=lambda k: float(modes_of(top / "m")[k]["growth_rad_s"]))
    head, whole, reals, values = shapes[grown]
    with h5py.File(top / "m/modes.h5") as file:
        shape = [file[f"VTKHDF/PointData/mode_{grown + 1:03d}_{part}"][:] for part in ("re", "im")]
        power = file[f"VTKHDF/PointData/mode_{grown + 1:03d}_feed_in_w_m2"][:]
    check(near(powers[grown][3], power.reshape(-1, 1)) and power.any(), "unv: the power that friction feeds a mode with")
    same = near(values[:, 0::2], shape[0]) and near(values[:, 1::2], shape[1]) and head[:5] == [1, 3, 2, 8, 5]
    check(same and abs(reals[0] / float(modes_of(top / "m")[grown]["growth_rad_s"]) - 1) < 1e-5 and whole[3] == grown + 1,
          f"unv: mode {grown + 1} is complex and grows by {reals[0]:g} 1/s")


def check_matrices(top):
    """Those of the brake."""
    import scipy.io
    sys.path.insert(0, str(SOURCE / "scripts"))
    from squeal.modes.exact import sparse
    made = run(EXPORT, "matrices", top / "matrices", "-o", top / "mm").split()
    check(sorted(Path(name).name for name in made) == ["F.mtx", "H.mtx", "K.mtx", "M.mtx"], "matrices: F, H, K, M")
    read = {name: scipy.io.mmread(top / f"mm/{name}.mtx") for name in "KMHF"}
    full = {name: read[name].toarray() for name in "KMH"}
    check(all(np.array_equal(full[name], sparse(top / f"matrices/{name}.bin").toarray()) for name in full), "matrices: the same numbers")
    values = np.linalg.eigvals(np.linalg.solve(full["M"], full["K"] + 0.9 * full["H"]))
    roots = np.sqrt(-values.astype(complex))
    roots = np.concatenate([roots, -roots])
    wanted = [complex(float(row["growth_rad_s"]), 2 * np.pi * float(row["freq_hz"])) for row in modes_of(top / "m")]
    worst = max(min(abs(roots - one)) / abs(one) for one in wanted)
    check(worst < 1e-8, f"matrices: eigenvalues by LAPACK, apart by {worst:.1e}")
    check(abs(read["F"].sum() + 100) < 1e-9, f"matrices: loads of {read['F'].sum():.9g} N")
    files = [f"{name}={top / f'mm/{name}.mtx'}" for name in "KMH"]
    run(SOURCE / "scripts/import_matrices", *files, "-o", top / "again")
    loads = [word for name in "kmh" for word in (f"-operators_load_{name}", top / f"again/{name.upper()}.bin")]
    squeal(*loads, "-contact_mu", 0.9, "-modes_band", "500,9000", "-output_dir", top / "back")
    pairs = [[(complex(float(row["growth_rad_s"]) / (2 * np.pi), float(row["freq_hz"])), float(row["error_hz"]))
              for row in modes_of(top / name)] for name in ("m", "back")]
    apart = max(abs(a - b) / (error_a + error_b) for (a, error_a), (b, error_b) in zip(*pairs))
    check(len(pairs[0]) == len(pairs[1]) and apart < 1 and max(error for _, error in pairs[1]) < 1e-6,
          f"matrices: by scripts/import_matrices and back, {len(pairs[0])} modes apart by {apart:.2f} of their errors")


def check_bad(top):
    """One line, and nothing of a final name."""
    (top / "empty").mkdir()
    (top / "file").write_text("no folder")
    for name, damage in (("torn", lambda data: data[:len(data) // 2]), ("flipped", lambda data: bytes(a ^ 255 for a in data))):
        (top / name).mkdir()
        for source, to in ((top / "m/modes.h5", "modes.h5"), (top / "matrices/K.bin", "K.bin"), (top / "matrices/M.bin", "M.bin")):
            (top / name / to).write_bytes(damage(source.read_bytes()))
    shutil.copytree(top / "m", top / "other", ignore=shutil.ignore_patterns("vtu", "*.unv"))
    with h5py.File(top / "other/modes.h5", "r+") as file:
        file["VTKHDF"].attrs["Version"] = [2, 1]
    shutil.copytree(top / "matrices", top / "mixed")
    shutil.copy(top / "small/M.bin", top / "mixed/M.bin")
    for words, said in ((("vtu", "nowhere"), "no such folder"), (("unv", "nowhere"), "no such folder"),
                        (("unv", top / "empty"), "no fields"), (("vtu", top / "torn"), "modes.h5"),
                        (("unv", top / "flipped"), "modes.h5"), (("vtu", top / "other"), "VTKHDF 2.1"),
                        (("vtu", top / "m", "--modes", "99"), "no shape of mode 99"), (("vtu", top / "m", "--pieces", "0"), "--pieces 0"),
                        (("unv", top / "m", "-o", top / "file/x.unv"), "file"), (("vtu", top / "m", "-o", top / "file"), "file"),
                        (("matrices", top / "empty"), "K.bin and M.bin"), (("matrices", top / "torn"), "K.bin"),
                        (("matrices", top / "flipped"), "K.bin"), (("matrices", top / "mixed"), "several runs"),
                        (("matrices", top / "matrices", "-o", top / "file"), "file")):
        done = run_command([EXPORT, *words], top)
        one = done.returncode == 1 and done.stderr.count("\n") == 1 and said in done.stderr and not done.stdout
        check(one, f"bad: {' '.join(str(word).removeprefix(str(top)) for word in words)}: {done.stderr.strip()[-300:]}")
    made = [path for name in ("empty", "torn", "flipped", "other", "mixed") for path in (top / name).rglob("*")
            if path.suffix in (".vtu", ".pvd", ".unv", ".mtx", ".part")]
    check(not made and not (top / "nowhere").exists(), f"bad: nothing is left but {made}")


def main():
    sys.argv[1:] = [str(Path(word).resolve()) for word in sys.argv[1:]]
    with tempfile.TemporaryDirectory(prefix="squeal-") as name:
        top = Path(name)
        (top / "scene.yaml").write_text(SCENE)
        for kind in SOLIDS:
            run(SOURCE / "tests/solids.py", kind, "--distort", 1, "--curve", top / f"{kind}.msh")
            squeal(*BAR, "-model_mesh", top / f"{kind}.msh", "-output_dir", top / kind, "-operators_save", top / "small")
            check_vtu(top / kind)
            check_unv(top / kind)
        check_series(top)
        check_matrices(top)
        check_bad(top)
    print("\n".join([f"{len(FAULTS)} faults", *FAULTS]))
    return 1 if FAULTS else 0


if __name__ == "__main__":
    with sooner(sys.argv[1]) as quick:
        sys.argv[1] = quick
        sys.exit(main())
