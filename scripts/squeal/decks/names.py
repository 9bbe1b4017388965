"""Names that squeal takes: letters, digits and _, each once."""

import re

# First words of squeal's, PETSc's and SLEPc's own options
RESERVED = set("""model modes operators static sweep frf dynamics squeal output eps st pep ts log rig projector parts supports
springs dashpots joints points loads contacts ties motions probes circles impulses options loss mat vec ksp pc dm is help version info
malloc error sub on off yes no true false null analysis statics objects citations checkpoint history viewer fp memory show start
sample superelement superelements quiet design petsc slepc bv ds rg svd nep snes tao sf blas mpi hdf5 mumps""".split())


class Names:
    """Gives each thing a name of its own."""

    def __init__(self, reserved=False):
        self.taken = set(RESERVED) if reserved else {"depth", "celltype", "dim", "vtk", "ghost"}

    def new(self, wanted):
        """The wanted name, as near as it goes."""
        name = re.sub(r"[^a-z0-9]+", "_", wanted.lower()).strip("_")[:60] or "set"
        if not name[0].isalpha():
            name = f"n{name}"
        found, number = name, 1
        while found in self.taken:
            number += 1
            found = f"{name}_{number}"
        self.taken.add(found)
        return found
