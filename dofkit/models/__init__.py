"""Importing models: which scene does a model of another program describe, and what of it was not read?

A reader takes the bytes of a file and returns a `ModelDocument` (`model_document`): the mapping of a scene, the line of
the file from which each part comes, and what was left out. `dofkit.scene` reads the mapping like any other scene, so
that an imported model is answered by the same code, and its faults name the lines of the model.

Formats (`formats` recognises a file by how it begins)
    `urdf`
        Robots of ROS: `urdf_elements` reads links and joints, `urdf` places them and writes the scene.
    `mjcf`
        Models of MuJoCo. Its own compiler reads them (`mujoco_model`, in a worker that can be killed), and `mjcf`
        writes what the compiler made of bodies, joints, equalities and tendons.
    `solvespace`
        Sketches of SolveSpace in one workplane; `sketch_constraints` has the equations of each kind of constraint.
        Sketches in space and derived groups are not read, and the scene says so.

Common parts: `markup` reads XML with lines and bounds, `joint_relations` writes relations between joints as a person
would. A constraint that is not read is a warning of the report, because the true freedom may be smaller.
"""
