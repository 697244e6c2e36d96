"""The real zero set of one equation, in pieces: finite, Pfaffian, nonlinear in the velocities, and conditions.

`normal_form.normalise` is the entry. `pieces` defines the types; `zero_set` and `polynomial_zeros` split an expression
into branches; `semidefinite` proves signs of polynomials; `domain` gives the conditions under which an expression has a
value, and resolves absolute values by cases; `no_solution` proves that there is no real point.
"""
