"""Command line: everything that the engine computes, for scripts and batch queues.

A module of `commands` is imported when its command runs: the import of the engine takes a second.
"""
