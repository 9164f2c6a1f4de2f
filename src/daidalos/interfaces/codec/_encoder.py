"""Source text of the function that serializes a message class."""

from __future__ import annotations

import struct
from typing import Any

from daidalos.interfaces.codec._text import FORMATS, HEADER, SIZES, Generator, Run, fixed_size
from daidalos.interfaces.message import Message


class Encoder(Generator):
    """Generator of ``parts(m) -> list of buffers``."""

    def source(self) -> tuple[str, dict[str, Any]]:
        self.emit("out = []")
        self.emit("add = out.append")
        self.run.items.append(("I", 1, 4))
        self.run.expressions.append("256" if self.variant.order == "<" else "0")
        self.static = -HEADER
        self.fields(self.root, "m")
        if not self.root._FIELDS:
            self.value("uint8", "0")
        self.flush()
        self.emit("return out")
        main = ["def parts(m):", *self.lines]
        text = []
        while self.pending:
            kind = self.pending.pop()
            self.lines, self.static, self.run = [], None, Run()
            self.fields(kind, "m")
            if not kind._FIELDS:
                self.value("uint8", "0")
            self.flush()
            self.emit("return p")
            text += [f"def {self.functions[kind]}(add, m, p):", *self.lines]
        self.lines = []
        return self.finish([*text, *main])

    def value(self, base: str, expression: str) -> None:
        size = SIZES[base]
        self.run.items.append((FORMATS[base], size, size))
        self.run.expressions.append(expression)

    def flush(self) -> None:
        """Write the struct call for the values collected so far."""
        run, self.run = self.run, Run()
        if not run.items:
            return
        arguments = ", ".join(run.expressions)
        if self.static is not None:
            text, size = run.layout(self.variant.order, self.static)
            name = self.names.of(text, struct.Struct(text).pack, "pack")
            self.emit(f"add({name}({arguments}))")
            self.static += size
            return
        key = (self.variant.order, tuple(run.items))
        table = self.names.of(key, run.structs(self.variant.order), "table")
        self.emit(f"s = {table}[p & 7]")
        self.emit(f"add(s.pack({arguments}))")
        self.emit("p += s.size")

    def dynamic(self, step: str) -> None:
        """Advance the offset by an amount that is only known at run time."""
        if self.static is None:
            self.emit(f"p += {step}")
        else:
            self.emit(f"p = {self.static} + {step}" if self.static else f"p = {step}")
            self.static = None

    def make_dynamic(self) -> None:
        if self.static is not None:
            self.emit(f"p = {self.static}")
            self.static = None

    def fields(self, kind: type[Message], owner: str) -> None:
        for name, base, many, size, bound in kind._FIELDS:
            expression = f"{owner}._{name}"
            if many == "single":
                self.single(base, expression)
            elif isinstance(base, str) and base not in ("string", "wstring"):
                self.primitives(base, many, size, expression)
            else:
                if bound is not None:  # what was appended to a list has not been checked
                    self.emit(f"if any(len(text) > {bound} for text in {expression}):")
                    self.emit(f"    raise ValueError('a string is longer than its bound, {bound}')")
                self.objects(base, many, size, expression)

    def single(self, base: Any, expression: str) -> None:
        if base == "string":
            text = self.fresh("b")
            self.emit(f"{text} = ({expression} + '\\0').encode()")
            self.value("uint32", f"len({text})")
            self.flush()
            self.emit(f"add({text})")
            self.dynamic(f"len({text})")
        elif base == "wstring":
            self.wide_string(expression)
        elif isinstance(base, str):
            self.value(base, expression)
        elif self.inlined(base):
            if not base._FIELDS:
                self.value("uint8", "0")
                return
            inner = self.fresh("m")
            self.emit(f"{inner} = {expression}")
            self.fields(base, inner)
        else:
            self.flush()
            self.make_dynamic()
            self.emit(f"p = {self.function(base)}(add, {expression}, p)")

    def wide_string(self, expression: str) -> None:
        text = self.fresh("w")
        order = "le" if self.variant.order == "<" else "be"
        self.emit(f"{text} = {expression}.encode('utf-16-{order}', 'surrogatepass')")
        self.value("uint32", f"len({text}) // 2")
        self.flush()
        if self.variant.wide == 4:
            self.emit(f"{text} = array('I', array('H', {text})).tobytes()")
        self.emit(f"add({text})")
        self.dynamic(f"len({text})")

    def primitives(self, base: str, many: str, size: int, expression: str) -> None:
        width = SIZES[base]
        if many == "array":
            self.run.items.append((f"{width * size}s", width, width * size))
            self.run.expressions.append(_raw(base, expression, ".tobytes()"))
            return
        values = self.fresh("v")
        self.emit(f"{values} = {expression}")
        if many == "bounded":
            self.emit(f"if len({values}) > {size}: raise ValueError('more than {size} values')")
        self.value("uint32", f"len({values})")
        self.flush()
        self.make_dynamic()
        self.emit(f"if {values}:")
        self.indent += 1
        if width == 8:
            pads = self.names.of("pads", tuple(bytes(n) for n in range(8)), "pads")
            self.emit("if p & 7:")
            self.emit(f"    add({pads}[-p & 7])")
            self.emit("    p += -p & 7")
        self.emit(f"add({_raw(base, values, '')})")
        self.emit(f"p += {width} * len({values})" if width > 1 else f"p += len({values})")
        self.indent -= 1

    def objects(self, base: Any, many: str, size: int, expression: str) -> None:
        values = self.fresh("v")
        self.emit(f"{values} = {expression}")
        if many == "array":
            self.emit(f"if len({values}) != {size}: raise ValueError('expected {size} values')")
        else:
            if many == "bounded":
                self.emit(f"if len({values}) > {size}: raise ValueError('more than {size} values')")
            self.value("uint32", f"len({values})")
        self.flush()
        self.make_dynamic()
        if base == "string":
            self.strings(values)
            return
        layout = None if isinstance(base, str) else fixed_size(base)
        if layout:
            self.repeated(base, values, *layout)
            return
        item = self.fresh("e")
        self.emit(f"for {item} in {values}:")
        self.indent += 1
        self.single(base, item)
        self.flush()
        self.indent -= 1

    def strings(self, values: str) -> None:
        """Write a list of strings; the offset is a multiple of 4 after a count, so each is padded to that.

        Names of joints and the like are the same in every message: the last block is kept and used again.
        """
        packers = self.names.of("lengths", struct.Struct(self.variant.order + "I").pack, "pack")
        tails = self.names.of("tails", (b"\0", b"\0\0\0\0", b"\0\0\0", b"\0\0"), "tails")
        block, item, text = self.fresh("v"), self.fresh("e"), self.fresh("b")
        self.emit(f"if {values}:")
        self.indent += 1
        self.emit("if p & 3:")
        self.emit("    add(bytes(-p & 3))")
        self.emit("    p += -p & 3")
        last = self.fresh("last")
        self.names.scope[last] = [([], b"")]
        self.emit(f"known, {block} = {last}[0]")
        self.emit(f"if known != {values}:")
        self.emit(f"    {block} = []")
        self.emit(f"    for {item} in {values}:")
        self.emit(f"        {text} = {item}.encode()")
        self.emit(f"        {block} += {packers}(len({text}) + 1), {text}, {tails}[len({text}) + 1 & 3]")
        self.emit(f"    {block}[-1] = b'\\0'")
        self.emit(f"    {block} = b''.join({block})")
        self.emit(f"    {last}[0] = {values}[:], {block}")
        self.emit(f"add({block})")
        self.emit(f"p += len({block})")
        self.indent -= 1

    def repeated(self, base: type[Message], values: str, size: int, alignment: int) -> None:
        """Write messages of fixed layout with one struct each."""
        expressions: list[str] = []
        run = Run()
        _flatten(base, "e", run, expressions)
        text, _ = run.layout(self.variant.order, 0)
        pack = self.names.of(text, struct.Struct(text).pack, "pack")
        self.emit(f"if {values}:")
        self.indent += 1
        if alignment > 4:
            self.emit("if p & 7:")
            self.emit("    add(bytes(-p & 7))")
            self.emit("    p += -p & 7")
        elif alignment > 1:
            self.emit(f"if p & {alignment - 1}:")
            self.emit(f"    add(bytes(-p & {alignment - 1}))")
            self.emit(f"    p += -p & {alignment - 1}")
        self.emit(f"add(b''.join([{pack}({', '.join(expressions)}) for e in {values}]))")
        self.emit(f"p += {size} * len({values})")
        self.indent -= 1


def _raw(base: str, values: str, to_bytes: str) -> str:
    """Return the expression for the bytes of many primitive values."""
    if base == "bool":
        return f"bytes({values})"
    if base == "byte":
        return f"b''.join({values})"
    return values + to_bytes


def _flatten(kind: type[Message], owner: str, run: Run, expressions: list[str]) -> None:
    """Collect the values of a message of fixed layout in one run."""
    for name, base, many, size, _ in kind._FIELDS:
        expression = f"{owner}._{name}"
        if isinstance(base, str):
            width = SIZES[base]
            if many == "array":
                run.items.append((f"{width * size}s", width, width * size))
                expressions.append(_raw(base, expression, ".tobytes()"))
            else:
                run.items.append((FORMATS[base], width, width))
                expressions.append(expression)
        elif many == "single":
            _flatten(base, expression, run, expressions)
        else:
            for i in range(size):
                _flatten(base, f"{expression}[{i}]", run, expressions)
