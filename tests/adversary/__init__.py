"""A standing adversary: scenes whose truth is known by how they are made, and a hunt for a wrong answer among them.

python -m tests.adversary [--minutes 10] [--seed 1] [--kinds components,rounding/least] [--certificates]

A family is a file: its functions draw a `KnownScene` from a random generator and a size. `registry` lists them,
`disguises` write a case in another way, `judgement` holds the report against the truth, `running` answers it, and
`found/` keeps what was answered wrongly once as tests.
"""
