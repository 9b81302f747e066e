"""One module for each command: its docstring is the help, and its function `run` has the options as parameters."""
