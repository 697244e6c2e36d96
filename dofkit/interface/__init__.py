"""The command line: which files, which question, and how are the answers printed?

Every command processes its files one by one in a worker that can be killed; a failing file does not stop the next.

From a command to its output
    1. `entry` begins and ends the process. `cli` and `assignment_commands` define the commands, `options` their
       arguments and help; `named_files` finds the files of a folder or a pattern.
    2. A `Request` states the question about a file. `jobs` sends requests to one worker, to several or to a cluster,
       in order and with a journal of the answers, so that an interrupted run resumes.
    3. In the worker, `answers` reads the file, calls the public functions of the package, and returns the text to
       print: the answer, or the faults of the file with their locations.
    4. `show` renders reports, equations of motion, faults and scenes: a `Sheet` of facts and sections, which is written
       as lines for a terminal or as HTML.
    5. `output` handles the standard streams and failures; `classification` prints reports one by one or writes them to
       a folder, with a summary; `named_files` also writes scenes for `new` and `convert`; `explanations` contains the
       entries of `dofkit explain`.
"""
