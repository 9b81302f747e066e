"""Command line: everything that the engine computes, for scripts and batch queues.

Each command imports the engine when it runs: the import takes seconds, which ``--help`` does not need.
"""
