#!/usr/bin/env python3
"""What is installed serves a program of one's own: the flags of squeal.pc compile and link it, and it runs. Breaks when
a header is missing or needs one of src, when a library is not named, or when the flags are those of the build.

    test_install.py MESON BUILD MPIRUN"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM = """
#include <squeal/squeal.h>

int main(int argc, char **argv)
{
  PetscErrorCode error = SquealInitialize(&argc, &argv, "a program of one's own");
  Model          model;

  if (!error) error = ModelCreate(PETSC_COMM_WORLD, &model);
  if (!error) error = ModelSetFromOptions(model);
  if (!error) error = ModelSetUp(model);
  if (!error) error = ModelView(model, PETSC_VIEWER_STDOUT_WORLD);
  if (!error) error = ModelDestroy(&model);
  return SquealFinalize(error);
}
"""
OPTIONS = ("-model_source rig -parts disc -rig_pad 0 -rig_disc_elements 3,12,1 -rig_disc_mesh axisymmetric "
           "-disc_young 2e11 -disc_density 7800")


def run(*command, **more):
    """Output of a command that must succeed."""
    done = subprocess.run(command, capture_output=True, text=True, **more)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def main():
    meson, build, mpirun = sys.argv[1], *(Path(name).resolve() for name in sys.argv[2:])
    with tempfile.TemporaryDirectory() as folder:
        top = Path(folder)
        run(meson, "install", "-C", build, "--no-rebuild", "--quiet", "--destdir", top)
        pc = next(top.rglob("squeal.pc"))
        lines = pc.read_text().splitlines()
        prefix = next(line.removeprefix("prefix=") for line in lines if line.startswith("prefix="))
        pc.write_text("\n".join(lines).replace(f"prefix={prefix}", f"prefix={top}{prefix}") + "\n")
        where = [str(pc.parent), os.environ.get("PKG_CONFIG_PATH", ""),
                 *(f"/usr/lib/{name}dir/{name}-real/lib/pkgconfig" for name in ("petsc", "slepc"))]
        flags = run("pkg-config", "--cflags", "--libs", "squeal",
                    env=os.environ | {"PKG_CONFIG_PATH": ":".join(filter(None, where))}).split()
        print("flags:", " ".join(flags))
        if any(str(build.parent) in flag for flag in flags):
            sys.exit("the flags name the folder of the build")
        (top / "one.c").write_text(PROGRAM)
        run("cc", "-std=c17", "-Wall", "-Wextra", "-Werror", "one.c", *flags, "-o", "one", cwd=top)
        shown = run(mpirun, "-n", "1", top / "one", *OPTIONS.split(), cwd=top)
        print(shown)
        if "disc" not in shown:
            sys.exit("the model does not show its part disc")


if __name__ == "__main__":
    main()
