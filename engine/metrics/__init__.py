"""Numbers that say how finely a map of escapes is divided, and how hard it is to predict where an orbit leaves."""
