"""Graphs of rigid links in general position: the rank of the links, the redundant ones, and what is rigid.

`linkage` reads a graph (`links`) and analyses it by its dimension; a `Linkage` contains the results.

| dimension | module | what decides | verdict |
|---|---|---|---|
| 1 | `links` | a spanning forest [Kirchhoff1847] | proved |
| 2 | `plane` | the (2,3) pebble game [PollaczekGeiringer1927] [Laman1970] [JacobsHendrickson1997] | proved |
| 3 | `space` | the rank at random positions modulo a prime [SchwartzZippel] | proved where a count agrees |

`rigid_blocks` stores the rigid blocks of a plane graph while links are added.
"""
