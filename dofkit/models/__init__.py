"""Importing models: which scene does a model of another program describe, and what was left out?

A reader takes the bytes of a file and returns a `ModelDocument` (`model_document`): the mapping of a scene, the line of
the file from which each part comes, and what was left out. `dofkit.scene` reads the mapping like any other scene, so
that an imported model is answered by the same code, and its faults name the lines of the model.

Formats (`formats` recognises a file by its first tag or bytes)
    `urdf`
        Robots of ROS: `urdf_elements` reads links and joints, `urdf` places them and writes the scene.
    `mjcf`
        Models of MuJoCo. MuJoCo's own compiler reads them (`mujoco_model`, in a worker that can be killed), and `mjcf`
        writes the compiled bodies, joints, equalities and tendons as a scene.
    `solvespace`
        Sketches of SolveSpace in one workplane; `sketch_constraints` writes the equations of each kind of constraint.
        3D sketches and derived groups are not read; the scene lists them as left out.

Common parts: `markup` reads XML with line numbers and limits, `joint_relations` writes relations between joints as
readable texts. A constraint that is not read becomes a warning of the report, because the true freedom may be smaller.
"""
