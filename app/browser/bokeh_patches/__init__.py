"""Replacements of two private functions of Bokeh, each with the corresponding change for upstream in a file ``*.patch``.

The server also works without them (``ESCAPE_EXPLORER_BOKEH_PATCHES=no``). The tests fail when a replaced function changes.
"""
