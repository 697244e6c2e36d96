"""Workers for a run of many things, which ends once they are closed."""

from __future__ import annotations

from dofkit.base.workers.crews import StoppedError
from dofkit.base.workers.job import Job, JobOutcome
from dofkit.base.workers.pool import Pool


class StoppablePool(Pool):
    """A pool that does nothing more once it was closed."""

    _stopped = False

    def run(self, job: Job) -> JobOutcome:
        """Do one job. Raises StoppedError where the pool was closed, or no worker can be started."""
        outcome = None if self._stopped else super().run(job)
        if outcome is None or self._stopped:
            raise StoppedError("the run was stopped")
        if outcome.ended == "absent":
            raise StoppedError(outcome.reason)
        return outcome

    def close(self) -> None:
        """End all workers, whatever they do."""
        self._stopped = True
        super().close()
