"""The entries: is each constraint holonomic, alone and in the system, and why."""
