"""The command line computes everything that the engine can, for scripts and batch queues.

A module of `commands` is imported only when its command runs, because importing the engine takes a second.
"""
