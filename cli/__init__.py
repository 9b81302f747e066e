"""The command line: everything that the engine computes, for scripts and batch queues.

Commands import the engine when they run, not before: it takes seconds to load, and no help text has to wait for it.
"""
