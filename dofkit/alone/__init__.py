"""Each method by itself: what it answers to each question, right or wrong, and how sure it may be of it.

A module a method, named as the method is, with a function for each question it answers: ``dof(scene, knobs)``,
``integrability(scene, knobs)``, ``redundancy(scene, knobs)`` and ``equivalence(scene, knobs, answer)``.
"""
