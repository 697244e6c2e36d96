"""The real zero set of one equation, in pieces: finite, Pfaffian, nonlinear in the velocities, and conditions.

`normal_form.normalise` is the entry. `pieces` has the types; `zero_set` and `polynomial_zeros` split an expression into
branches; `semidefinite` proves signs of polynomials; `domain` says where an expression has a value and tells absolute
values apart; `no_solution` proves that there is no real point, by `sign_claims` and by resultants.
"""
