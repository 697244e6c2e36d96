"""The command line: which files are asked about, what is asked, and how are the answers printed?

Every command answers its files one by one in a worker that can be killed, and no file stops those that follow.

From a command to its output
    1. `entry` begins and ends the process. `cli` and `assignment_commands` have the commands, `options` their
       arguments with the help, `named_files` the files that a folder or a pattern stands for.
    2. A `Request` says what is asked about a file. `jobs` hands requests to one worker, to several or to a cluster, in
       order and with a journal, so that an interrupted run resumes.
    3. In the worker, `answers` reads the file, asks the public functions of the package, and returns the lines that
       are printed, or the faults of the file with their locations.
    4. `show` renders reports, motions, faults and scenes: a `Sheet` of facts and sections, which is written as lines
       for a terminal or as a page.
    5. `output` knows the standard streams and how a command fails; `classification` prints reports as they come or
       keeps them in a folder, with a summary; `named_files` has `new` and `convert`; `explanations` has every word
       that `dofkit explain` knows.
"""
