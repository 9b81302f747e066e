"""Command line: everything that the engine computes, for scripts and batch queues.

A module of `commands` is imported only when its command runs, because the import of the engine takes a second.
"""
