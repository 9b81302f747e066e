"""The commands, one module each. The docstring is the help, and the parameters of the function `run` are the options."""
