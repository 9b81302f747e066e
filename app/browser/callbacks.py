"""JavaScript of this folder for components, and for Bokeh's callbacks, which are bodies of functions."""

from __future__ import annotations

from pathlib import Path


def module_path(module: str) -> Path:
    """Path of a module of this folder, for a component."""
    return Path(__file__).with_name(module)


def callback_code(module: str, call: str) -> str:
    """The functions of a module of this folder, and a call of one of them, such as ``label(tick, base)``."""
    source = module_path(module).read_text(encoding="utf-8")
    return f"{source.replace('export function', 'function')}\nreturn {call}"
