"""Make options from the parameters of a function or dataclass, with help from its docstring."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Collection, Mapping
from copy import copy
from dataclasses import is_dataclass
from typing import Annotated, Any, get_args, get_origin

import typer
from typer.models import OptionInfo, ParameterInfo

from cli.arguments import OPTION_TYPES, READERS
from cli.option_marks import DocumentedBy, OptionChanges

MISSING = inspect.Parameter.empty

NAMES = {"use_evidence": ("--evidence/--no-evidence",)}
"""Names of options by parameter, where they differ from the name of the parameter."""


def with_options(function: Callable[..., None]) -> Callable[..., None]:
    """Return a function whose parameters are the options of `function`.

    The returned function builds the request dataclasses from the options, and calls `function`.
    """

    def run(**values: Any) -> None:
        _build(function, values)

    options = _list_options(function)
    run.__annotations__ = {name: option.annotation for name, option in options.items()}
    run.__signature__ = inspect.Signature(list(options.values()))  # type: ignore[attr-defined]
    return run


def _list_options(make: Callable[..., Any]) -> dict[str, inspect.Parameter]:
    """Return the options of a function or request, by name. `_build` makes arguments from the values of these options."""
    options: dict[str, inspect.Parameter] = {}
    for parameter in _parameters(make):
        kind, marks = _split_annotation(parameter.annotation)
        reader = _find_reader(kind)
        if reader is None:
            options[parameter.name] = _make_option(make, parameter)
            continue
        changes = next((mark for mark in marks if isinstance(mark, OptionChanges)), OptionChanges())
        for name, option in _list_options(reader).items():
            if name not in changes.without:
                options[name] = option.replace(default=changes.defaults.get(name, option.default))
    return options


def _build(make: Callable[..., Any], values: Mapping[str, Any]) -> Any:
    """Call a function, or make a request, with the values of its options."""
    arguments = {}
    for parameter in _parameters(make):
        reader = _find_reader(_split_annotation(parameter.annotation)[0])
        if reader is not None:
            arguments[parameter.name] = _build(reader, values)
        elif parameter.name in values:
            arguments[parameter.name] = values[parameter.name]
    return make(**arguments)


def _find_reader(kind: Any) -> Callable[..., Any] | None:
    """Return the function that makes a value from several options; None for a type that needs one option."""
    if kind in READERS:
        return READERS[kind]
    return kind if isinstance(kind, type) and is_dataclass(kind) else None


def _make_option(make: Callable[..., Any], parameter: inspect.Parameter) -> inspect.Parameter:
    """Return a keyword parameter for Typer, with names, help and default."""
    kind, marks = _split_annotation(parameter.annotation)
    origin = next((mark for mark in marks if isinstance(mark, DocumentedBy)), DocumentedBy(make))
    source_name = origin.name or parameter.name
    default = parameter.default
    if default is MISSING and origin.owner is not make:
        default = inspect.signature(origin.owner).parameters[source_name].default
    # The mark may set what a docstring cannot, such as the metavar. Copy it, because annotations are shared.
    info = copy(next((mark for mark in marks if isinstance(mark, ParameterInfo)), typer.Option()))
    info.help = info.help or _find_help(origin.owner, source_name)
    # In `Annotated`, `Option("--name")` stores the name in `default`, and ... means that no name was given.
    if isinstance(info, OptionInfo) and info.default is ...:
        info.param_decls = _option_names(parameter.name, default)
    if isinstance(default, tuple):
        # The resolution is one word, such as 224x224.
        default = "x".join(map(str, default))
    return inspect.Parameter(parameter.name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[kind, info])


def _option_names(parameter: str, default: Any) -> tuple[str, ...]:
    """Return the names of an option. A flag that is on by default also has a name that switches it off."""
    if parameter in NAMES:
        return NAMES[parameter]
    name = parameter.replace("_", "-")
    return (f"--{name}/--no-{name}",) if default is True else (f"--{name}",)


def _find_help(owner: Callable[..., Any], name: str) -> str:
    """Return the first sentence about a parameter in the docstring of its owner."""
    entry = re.search(rf"^{name}\n((?: +.+\n?)+)", inspect.getdoc(owner) or "", re.MULTILINE)
    if entry is None:
        return ""
    text = re.sub(r"\s+", " ", entry[1]).strip().replace("`", "")
    return re.split(r"(?<=\.) (?=[A-Z])", text)[0]


def _parameters(make: Callable[..., Any]) -> Collection[inspect.Parameter]:
    """Return the parameters of a function or a request, with evaluated annotations."""
    return inspect.signature(make, eval_str=True).parameters.values()


def _split_annotation(annotation: Any) -> tuple[Any, tuple[Any, ...]]:
    """Return the type of an option and the marks of its annotation."""
    kind, *marks = get_args(annotation) if get_origin(annotation) is Annotated else (annotation,)
    if kind in OPTION_TYPES:
        kind, *more_marks = get_args(OPTION_TYPES[kind])
        marks += more_marks
    return kind, tuple(marks)
