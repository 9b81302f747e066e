"""The commands, one module each: the module's docstring is the help, and the parameters of its function `run` are the options."""
