"""Work in processes that can be killed and replaced: a job never hangs, crashes or starves its caller.

>>> from dofkit.base.workers import Job
>>> from dofkit.base.workers.pool import Pool
>>> with Pool(1) as pool:
...     pool.run(Job("operator:neg", 7, seconds=10.0)).value
-7

A worker bounds its own memory and processor time, and its parent keeps the wall clock (`worker`, the parent's side, and
`child`). It is a fresh Python that imports what the job names and nothing of the caller's ``__main__``, so scripts need
no guard; or, where one small file has to be answered at once, a fork. `pool` has several workers, here or in a cluster.

Two libraries were tried. In `loky` one crash fails every job under way, and no job can be killed. `pebble` kills and
bounds jobs well, but the death of an idle worker ends its pool, a job cut short leaves no partial value, scripts
without a guard run twice, and its import takes a sixth of the time in which a small file is answered.
"""

from __future__ import annotations

from dofkit.base.workers.worker import MEMORY, Ended, Job, JobOutcome, Json, Worker

__all__ = ["MEMORY", "Ended", "Job", "JobOutcome", "Json", "Worker"]
