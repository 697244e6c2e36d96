"""One file of ``dofkit lagrange``, from its bytes to the lines that are printed; this runs in a worker."""

from __future__ import annotations

from dofkit.base.errors import SceneError
from dofkit.base.workers import Json
from dofkit.interface.classify_file import faults_of_error, line, printed, unread
from dofkit.interface.show.motion import as_lines
from dofkit.interface.supervised import Given
from dofkit.motion.lagrange.equations import lagrange
from dofkit.scene.reading import SceneFile, find


def told(asked: tuple[Given, bool]) -> Json:
    """What is printed of a file: ``out``, ``err`` and whether it ``failed``; the second tells of small motions too."""
    given, linearize = asked
    name, document = given.name, None
    try:
        name, data = find(given.file) if given.data is None else (name, given.data)
        read = SceneFile.read(data, name)
        document = read.document
        scene = read.scene(checked=False)
        try:
            report = lagrange(scene, linearize, given.budget)
        except SceneError as error:
            raise read.located(error) from None
        if given.as_json:
            return printed(line(report.model_dump(mode="json"), given))
        return printed(as_lines(report, scene.title) + "\n")
    except MemoryError:
        raise
    except Exception as error:
        return unread(given, name, faults_of_error(error), document)
