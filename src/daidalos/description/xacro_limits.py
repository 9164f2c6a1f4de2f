"""Limits for the `xacro` package: what its expressions may do, and which files they may read.

The package evaluates expressions by Python's `eval` and reads YAML files from anywhere. While it runs, its functions
are replaced by those of `Evaluator`, which computes values only, and by a reader of the YAML files of packages.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from daidalos.common.documents import parse_yaml, read_text
from daidalos.description.expressions import Evaluator, ExpressionError

_MANIFEST = "package.xml"
_FILE_STEPS, _MACRO_STEPS, _ELEMENT_STEPS = 1_000, 200, 10
"""Steps of the evaluator's allowance that a file, a call of a macro and an element take, as far as they take longer."""


class ReadableFiles:
    """Folders from which an expression may read YAML files.

    These are the packages of the xacro files that were read and of those that ``$(find)`` found, and what the user
    named as an argument. Links are resolved first.

    Parameters
    ----------
    mappings : mapping
        The user's arguments.
    """

    def __init__(self, mappings: Mapping[str, str] | None = None) -> None:
        mappings = mappings or {}
        self._named = {path.resolve() for path in map(_existing, mappings.values()) if path is not None}
        self._folders: set[Path] = set()

    def add_file(self, path: Path) -> None:
        """Add the package of a xacro file; its folder where it is in none."""
        real = path.resolve()
        package = next((folder for folder in real.parents if (folder / _MANIFEST).is_file()), real.parent)
        self._folders.add(package)

    def add_package(self, share: Path) -> None:
        """Add a package; with links to its sources, as ``--symlink-install`` makes them, these as well."""
        self._folders.update((share.resolve(), (share / _MANIFEST).resolve().parent))

    def check(self, path: Path) -> None:
        """Raise ExpressionError for a file that may not be read."""
        real = path.resolve()
        if not any(real == one or real.is_relative_to(one) for one in (*self._named, *self._folders)):
            raise ExpressionError(
                f"load_yaml: '{path}' is outside of the packages of this description; name the file in an argument"
            )


@contextmanager
def limited(xacro: Any, files: ReadableFiles) -> Iterator[Evaluator]:
    """Replace the functions of the `xacro` package by limited ones; yield their evaluator."""
    from xacro import substitution_args

    evaluator = Evaluator(namespaces=(xacro.Table,), dotted=(xacro.YamlDictWrapper,))
    eval_text, eval_all, call_macro, parse = xacro.eval_text, xacro.eval_all, xacro.handle_macro_call, xacro.parse
    find = substitution_args._eval_find

    def counted_text(text: str, symbols: Any) -> Any:
        evaluator.charge(1)
        return evaluator.checked(eval_text(text, symbols))

    def counted_elements(*arguments: Any) -> Any:
        evaluator.charge(_ELEMENT_STEPS)
        return eval_all(*arguments)

    def counted_macro(*arguments: Any) -> Any:
        evaluator.charge(_MACRO_STEPS)
        return call_macro(*arguments)

    def counted_file(text: Any, filename: str | None = None) -> Any:
        evaluator.charge(_FILE_STEPS)
        if filename is not None:
            files.add_file(Path(xacro.root_dir) / filename)
        return parse(text, filename)

    def find_package(name: str) -> str:
        share = find(name)
        files.add_package(Path(share))
        return str(share)

    def safe_eval(expression: str, symbols: Any, variables: Any = None) -> Any:
        return evaluator.evaluate(expression, symbols)

    def evaluate_substitution(expression: str, context: dict[str, Any]) -> str:
        return str(evaluator.evaluate(expression, _substitution_names(substitution_args, context, evaluator)))

    replaced: list[tuple[Any, str, Any]] = [
        (vars(xacro), "eval_text", counted_text),
        (vars(xacro), "eval_all", counted_elements),
        (vars(xacro), "handle_macro_call", counted_macro),
        (vars(xacro), "parse", counted_file),
        (vars(xacro), "safe_eval", safe_eval),
        (vars(substitution_args), "_eval", evaluate_substitution),
        (vars(substitution_args), "_eval_find", find_package),
        (substitution_args._eval_dict, "find", find_package),
    ]
    functions = {
        **evaluator.functions(),
        "load_yaml": _yaml_reader(xacro, evaluator, files),
        "tokenize": _tokenize,
        "vars": _refused("vars"),
    }
    symbols = xacro._global_symbols
    replaced += [
        (place, name, _deprecated_alike(xacro, place is symbols, name, function))
        for name, function in functions.items()
        for place in (symbols, symbols["python"], symbols["math"], symbols["xacro"])
        if dict.__contains__(place, name)
    ]
    before = [(place, name, dict.__getitem__(place, name)) for place, name, _ in replaced]
    for place, name, function in replaced:
        dict.__setitem__(place, name, function)
    try:
        yield evaluator
    finally:
        for place, name, function in before:
            dict.__setitem__(place, name, function)


def _yaml_reader(xacro: Any, evaluator: Evaluator, files: ReadableFiles) -> Callable[[str], Any]:
    """Return xacro's ``load_yaml`` for the files of packages."""
    import yaml

    class Loader(yaml.SafeLoader):
        """Loader with xacro's units."""

    for unit in xacro.ConstructUnits:
        Loader.add_constructor(unit.value.tag, unit.constructor)

    def load_yaml(filename: str) -> Any:
        path = Path(xacro.abs_filename_spec(filename))
        files.check(path)
        evaluator.charge(_FILE_STEPS)
        text = read_text(path)
        xacro.filestack.append(str(path))
        try:
            return xacro.YamlListWrapper.wrap(parse_yaml(text, str(path), Loader))
        finally:
            xacro.filestack.pop()
            xacro.all_includes.append(str(path))

    return load_yaml


def _tokenize(text: str, separators: str = ",; ", skip_empty: bool = True) -> list[str]:
    """Split a text at any of the separators; without the patterns that xacro's own allows, which may take for ever."""
    parts = re.split(f"[{re.escape(separators)}]", text)
    return [part for part in parts if part] if skip_empty else parts


def _substitution_names(substitution_args: Any, context: dict[str, Any], evaluator: Evaluator) -> Any:
    """Return the names of ``$(eval ...)``."""
    arguments = context.setdefault("arg", {})
    known = {name: value for name, value in substitution_args._eval_dict.items() if not name.startswith("_")}
    builtins = {"list": list, "dict": dict, "str": str, "float": float, "int": int}

    def argument(name: str) -> Any:
        return substitution_args.convert_value(substitution_args._eval_arg(name, args=arguments), "auto")

    def folder() -> Any:
        return substitution_args._eval_dirname(context["filename"])

    names = {**known, **builtins, **evaluator.functions(), "arg": argument, "dirname": folder}
    return substitution_args._DictWrapper(arguments, names)


def _deprecated_alike(xacro: Any, is_global: bool, name: str, function: Any) -> Any:
    """Return a function that warns, as xacro's does, where it is used without the namespace that it moved to."""
    moved = {"load_yaml": "xacro", "range": "python", "sorted": "python"}
    if not (is_global and name in moved):
        return function

    def warning(*arguments: Any, **options: Any) -> Any:
        space = moved[name]
        xacro.warning(f"Using {name}() directly is deprecated. Use {space}.{name}() instead.")
        return function(*arguments, **options)

    return warning


def _refused(name: str) -> Callable[..., Any]:
    def refuse(*arguments: Any) -> Any:
        raise ExpressionError(f"'{name}' is not for expressions")

    return refuse


def _existing(text: str) -> Path | None:
    try:
        path = Path(text)
        return path if text and path.exists() else None
    except (OSError, ValueError):
        return None
