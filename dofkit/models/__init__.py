"""Importing models: which scene does a model of another program describe, and what of it was not read?

A reader takes the bytes of a file and gives a `ModelDocument` (`model_document`): the mapping of a scene, where in
the file each of its parts is from, and what was left out. `dofkit.scene` reads the mapping like any other scene, so
that an imported model is answered by the same code, and its faults name the lines of the model.

Formats (`formats` recognises a file by how it begins)
    `urdf`
        Robots of ROS: `urdf_elements` reads links and joints, `urdf_loops` the joints that close loops.
    `mjcf`
        Models of MuJoCo. Its own compiler reads them (`compiled_by_mujoco`, in a worker that can be killed), and
        `mujoco_model` lists what the compiler made of bodies, joints, equalities and tendons.
    `solvespace`
        Sketches of SolveSpace: `sketch_file` reads records, `sketch_types` has the numbers of their types.
        `plane_sketch` and `spatial_sketch` make scenes of `sketch_scene`. `sketch_geometry`, `sketch_relations` and
        `sketch_frames` belong to the plane; `sketch_entities`, `sketch_space`, `sketch_mentions`, `sketch_faces`,
        `sketch_copies` and `sketch_space_relations` to space.

Common parts: `markup` reads XML with lines and bounds, `parts` finds the files that a model includes,
`joint_relations` writes relations between joints as a person would, and `scene_text` writes the scene as a YAML file.
"""
