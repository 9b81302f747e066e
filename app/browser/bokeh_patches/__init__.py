"""Replacements of two private functions of Bokeh. For each, a file ``*.patch`` contains the change for upstream.

The server also works without the replacements (``ESCAPE_EXPLORER_BOKEH_PATCHES=no``). Tests fail if a replaced function changes.
"""
