/*
   Substructure - some parts of a scene reduced to matrices on their interface and on modes, a superelement:

      u = T q,   K_s = T'K T,   M_s = T'M T,   C_s = T'C T        (N/m, kg, N s/m where q is a displacement)

   u has the displacements of the parts by themselves: what is in contact with them, shares nodes with them or is tied
   to them is left out. q begins with the displacements u_b of the nodes of the interface, and goes on with modal
   coordinates. u_i is the rest, i inside.

      fixed  u_i = -K_ii^-1 K_ib u_b + Phi eta + X zeta; Phi the modes with the interface held (Craig and Bampton 1968);
             X static answers to the inertia of the static shapes, as many as -superelement_rtol asks for (inertia.c)
      free   u = Phi eta + R f; Phi the modes with the interface free, R the residual flexibility of what they leave
             out, f the forces on the interface, in whose place u_b stands (MacNeal 1971; Rubin 1975)
      none   q = u

   Phi has all modes below a cut-off. T is the same for all terms of K, M and C, so that a superelement depends on the
   moduli and densities of its parts as the parts do: K_s(p) = sum_j c_j(p) T'A_j T. Of the values of the scene it has
   the error below; of others one that nothing says, but where all moduli have one factor, which leaves T as it is.

   Errors are estimates. The modes x of the superelement by itself, with the interface free and with it held, leave the
   residual r = K x - kappa M x, kappa = omega^2, in the matrices of the parts. What can still be gained is what lies
   inside beyond the modes: kappa falls by about r_i' (K_ii - kappa M_ii)^-1 r_i <= r_i' K_ii^-1 r_i / (1 - kappa /
   kappa_next), kappa_next the square of the cut-off, or the next mode that is found. Modes of one band are corrected
   together.
*/
#pragma once

#include <squeal/operators.h>
#include <squeal/results.h>

typedef struct _p_Substructure *Substructure;

/*@ SubstructureCreate - makes an empty one. Collective. @*/
PetscErrorCode SubstructureCreate(MPI_Comm comm, Substructure *s);

/*@ SubstructureSetFromOptions - reads which parts, which interface, how, and how far. Collective.

   Options are the rows of src/substructure/quantities.c. @*/
PetscErrorCode SubstructureSetFromOptions(Substructure s);

/*@ SubstructureVisit - shows the rows of its options. Collective. @*/
PetscErrorCode SubstructureVisit(Substructure s, const QuantityVisitor *visitor);

/*@ SubstructureSetOperators - the operators, and the point p of their parameters, both borrowed. Not collective. @*/
PetscErrorCode SubstructureSetOperators(Substructure s, Operators operators, const PetscReal p[]);

/*@
   SubstructureSolve - reduces the parts and estimates the error. Collective.

   Errors: PETSC_ERR_USER_INPUT for parts or sets that there are not, a set that is not on the parts, a band without
   modes, an interface that does not hold the parts (fixed) or has no flexibility of its own (free), and where others
   share nodes with the parts, or are tied or joined to them, beyond the interface; PETSC_ERR_SUP for parts that spin,
   and matrices without a mesh.
@*/
PetscErrorCode SubstructureSolve(Substructure s);

/*@ SubstructureView - sizes, and the modes in the band with their errors. Collective. @*/
PetscErrorCode SubstructureView(Substructure s, PetscViewer viewer);

/*@ SubstructureWrite - the files of -superelement_formats, superelement.csv and superelement_terms.csv. Collective. @*/
PetscErrorCode SubstructureWrite(Substructure s, Results results);

/*@ SubstructureDestroy - frees it. Collective. @*/
PetscErrorCode SubstructureDestroy(Substructure *s);
