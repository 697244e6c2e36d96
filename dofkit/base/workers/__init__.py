"""Work in processes of their own, which can be killed and replaced: a job never hangs, crashes or starves its caller.

>>> from dofkit.base.workers.job import Job
>>> from dofkit.base.workers.pool import Pool
>>> with Pool(1) as pool:
...     pool.run(Job("operator:neg", 7, seconds=10.0)).value
-7

A worker is a fresh Python that imports what the job names and nothing of the caller's ``__main__``, so scripts need no
guard; it takes jobs over a pipe and bounds its own memory and processor time. Its parent keeps the wall clock.
"""

from __future__ import annotations

from dofkit.base.workers.job import Ended, Job, JobOutcome, Json
from dofkit.base.workers.worker import MEMORY, Worker

__all__ = ["MEMORY", "Ended", "Job", "JobOutcome", "Json", "Worker"]
