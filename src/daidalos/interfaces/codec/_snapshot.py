"""Source text of the function that copies a message deeply."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from daidalos.interfaces.codec._text import Generator, Variant
from daidalos.interfaces.message import TYPECODES, Message


class Snapshot(Generator):
    """Generator of ``snapshot(m) -> message``; immutable values are shared, all others are copied.

    Parameters
    ----------
    root
        The message's class.
    unfit
        Makes the error to raise of a message that cannot be copied and of what went wrong.
    """

    def __init__(self, root: type[Message], unfit: Callable[[Any, Exception], Exception]) -> None:
        super().__init__(root, Variant())
        self.names.scope["unfit"] = unfit

    def source(self) -> tuple[str, dict[str, Any]]:
        self.emit("try:")
        self.indent = 2
        result = self.copy(self.root, "m")
        self.emit(f"return {result}")
        self.indent = 1
        self.emit("except (AttributeError, TypeError) as error:")
        self.indent = 2
        self.emit("raise unfit(m, error) from None")
        main = ["def snapshot(m):", *self.lines]
        text: list[str] = []
        while self.pending:
            kind = self.pending.pop()
            self.lines, self.indent = [], 1
            result = self.copy(kind, "m")
            self.emit(f"return {result}")
            text += [f"def {self.functions[kind]}(m):", *self.lines]
        self.lines = []
        return self.finish([*text, *main])

    def copy(self, kind: type[Message], owner: str) -> str:
        name = self.fresh("c")
        self.emit(f"{name} = new({self.names.kind(kind)})")
        for attribute, base, many, _, _ in kind._FIELDS:
            source, target = f"{owner}._{attribute}", f"{name}._{attribute}"
            if many == "single":
                self.single(base, source, target)
            elif isinstance(base, str):
                copied = f"{source}.copy()" if many == "array" and base in TYPECODES else f"{source}[:]"
                self.emit(f"{target} = {copied}")
            else:
                function = self.function(base)
                self.emit(f"{target} = [{function}(e) for e in {source}]")
        return name

    def single(self, base: Any, source: str, target: str) -> None:
        if isinstance(base, str):
            self.emit(f"{target} = {source}")
        elif self.inlined(base):
            inner = self.fresh("m")
            self.emit(f"{inner} = {source}")
            self.emit(f"{target} = {self.copy(base, inner)}")
        else:
            self.emit(f"{target} = {self.function(base)}({source})")
