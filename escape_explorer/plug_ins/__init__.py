"""Names for packages that add entries to the program, see "Example: entries in a package of your own" in docs/extending.md.

The modules `systems`, `measures`, `layers` and `studies` have the classes of entries, and what entries need besides the names of
`escape_explorer`. They may change with any minor version.
"""
