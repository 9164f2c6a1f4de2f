"""Source text of the function that deserializes a message class."""

from __future__ import annotations

import struct
from typing import Any

from daidalos.interfaces.codec._text import FORMATS, HEADER, SIZES, Generator, Run
from daidalos.interfaces.message import TYPECODES, Message


class Decoder(Generator):
    """Generator of ``decode(buf) -> message``.

    Offsets count from the start of the buffer, so alignment is relative to offset 4.
    """

    def source(self) -> tuple[str, dict[str, Any]]:
        self.static = HEADER
        self.emit("end = len(buf)")
        if self.needs_view(self.root):
            self.emit("view = memoryview(buf)")
        result = self.message(self.root)
        self.flush()
        stop = "p" if self.static is None else str(self.static)
        # Middlewares pad what they send to a multiple of four.
        self.emit(f"if end - {stop} > 3: raise ValueError(f'{{end - {stop}}} bytes are left over')")
        self.emit(f"return {result}")
        main = ["def decode(buf):", *self.lines]
        text: list[str] = []
        while self.pending:
            kind = self.pending.pop()
            self.lines, self.static, self.run, self.indent = [], None, Run(), 1
            result = self.message(kind)
            self.flush()
            self.emit(f"return {result}, p")
            text += [f"def {self.functions[kind]}(buf, view, p, end):", *self.lines]
        self.lines = []
        return self.finish([*text, *main])

    def needs_view(self, kind: type[Message]) -> bool:
        """Return whether reading the message slices arrays or calls functions."""
        return any(
            many != "single" or (not isinstance(base, str) and (not self.inlined(base) or self.needs_view(base)))
            for _, base, many, _, _ in kind._FIELDS
        )

    def value(self, base: str, target: str) -> None:
        size = SIZES[base]
        self.run.items.append((FORMATS[base], size, size))
        self.run.expressions.append(target)

    def flush(self) -> None:
        """Write the struct call that reads the values collected so far."""
        run, self.run = self.run, Run()
        if not run.items:
            return
        targets = ", ".join(run.expressions) + ","
        if self.static is not None:
            text, size = run.layout(self.variant.order, self.static - HEADER)
            name = self.names.of(text, struct.Struct(text).unpack_from, "unpack")
            self.emit(f"{targets} = {name}(buf, {self.static})")
            self.static += size
            return
        key = (self.variant.order, tuple(run.items))
        table = self.names.of(key, run.structs(self.variant.order, HEADER), "table")
        self.emit(f"s = {table}[p & 7]")
        self.emit(f"{targets} = s.unpack_from(buf, p)")
        self.emit("p += s.size")

    def make_dynamic(self) -> None:
        if self.static is not None:
            self.emit(f"p = {self.static}")
            self.static = None

    def message(self, kind: type[Message]) -> str:
        """Write the code that creates one message; its fields are set as their values are read."""
        name = self.fresh("m")
        self.emit(f"{name} = new({self.names.kind(kind)})")
        if not kind._FIELDS:
            self.value("uint8", "_")
        for attribute, base, many, size, bound in kind._FIELDS:
            target = f"{name}._{attribute}"
            if many == "single":
                self.single(base, target)
            elif isinstance(base, str) and base not in ("string", "wstring"):
                self.primitives(base, many, size, target)
            else:
                self.objects(base, many, size, target)
            if bound is not None:
                texts = f"({target},)" if many == "single" else target
                self.emit(f"if any(len(text) > {bound} for text in {texts}):")
                self.emit(f"    raise ValueError('a string is longer than its bound, {bound}')")
        return name

    def single(self, base: Any, target: str) -> None:
        if base == "string":
            self.string(target)
        elif base == "wstring":
            self.wide_string(target)
        elif isinstance(base, str):
            self.value(base, target)
        elif self.inlined(base):
            inner = self.message(base)
            self.emit(f"{target} = {inner}")
        else:
            self.flush()
            self.make_dynamic()
            self.emit(f"{target}, p = {self.function(base)}(buf, view, p, end)")

    def string(self, target: str) -> None:
        count = self.fresh("n")
        self.value("uint32", count)
        self.flush()
        start = str(self.static) if self.static is not None else "p"
        self.emit(f"q = {start} + {count}")
        self.emit(f"if q > end or buf[q - 1]: raise ValueError(f'a string of {{{count}}} bytes has no end')")
        self.emit(f"{target} = str(buf[{start}:q - 1], 'utf-8', 'replace') if {count} else ''")
        self.emit("p = q")
        self.static = None

    def wide_string(self, target: str) -> None:
        count, width = self.fresh("n"), self.variant.wide
        order = "le" if self.variant.order == "<" else "be"
        self.value("uint32", count)
        self.flush()
        self.make_dynamic()
        self.emit(f"q = p + {width} * {count}")
        self.emit(f"if q > end: raise ValueError(f'a string of {{{count}}} characters does not fit')")
        data = "buf[p:q]"
        if width == 4:
            units = self.fresh("w")
            self.emit(f"{units} = array('I', {data})")
            if self.variant.order == ">":
                self.emit(f"{units}.byteswap()")
            data = f"array('H', {units}).tobytes()"
            order = "le"
        self.emit(f"{target} = str({data}, 'utf-16-{order}', 'surrogatepass')")
        self.emit("p = q")

    def primitives(self, base: str, many: str, size: int, target: str) -> None:
        width = SIZES[base]
        if many == "array":
            raw = self.fresh("a")
            self.run.items.append((f"{width * size}s", width, width * size))
            self.run.expressions.append(raw)
            self.flush()
            self.emit(f"{target} = {self.array_value(base, raw)}")
            return
        count = self.fresh("n")
        self.value("uint32", count)
        self.flush()
        self.make_dynamic()
        if many == "bounded":
            self.emit(f"if {count} > {size}: raise ValueError(f'{{{count}}} values, at most {size} are allowed')")
        if width == 8:
            self.emit(f"if {count}: p += 4 - p & 7")
        self.emit(f"q = p + {width} * {count}" if width > 1 else f"q = p + {count}")
        self.emit(f"if q > end: raise ValueError(f'{{{count}}} values do not fit')")
        if base in TYPECODES:
            values = self.fresh("v")
            self.emit(f"{target} = {values} = array({TYPECODES[base]!r})")
            self.emit(f"{values}.frombytes(view[p:q])")
            if self.variant.order == ">" and width > 1:
                self.emit(f"{values}.byteswap()")
        elif base == "bool":
            self.emit(f"{target} = [b != 0 for b in view[p:q]]")
        else:
            self.emit(f"{target} = [buf[i:i + 1] for i in range(p, q)]")
        self.emit("p = q")

    def array_value(self, base: str, raw: str) -> str:
        """Return the expression that turns the bytes of a fixed array into its value."""
        if base == "bool":
            return f"[b != 0 for b in {raw}]"
        if base == "byte":
            return f"[{raw}[i:i + 1] for i in range(len({raw}))]"
        import numpy

        dtype = numpy.dtype(TYPECODES[base]).newbyteorder("<" if self.variant.order == "<" else ">")
        from_buffer = self.names.of("frombuffer", numpy.frombuffer, "frombuffer")
        wire = self.names.of(("dtype", base, self.variant.order), dtype, "dtype")
        native = self.names.of(("native", base), numpy.dtype(TYPECODES[base]), "native")
        return f"{from_buffer}({raw}, {wire}).astype({native})"

    def objects(self, base: Any, many: str, size: int, target: str) -> None:
        count = str(size)
        if many != "array":
            count = self.fresh("n")
            self.value("uint32", count)
        self.flush()
        self.make_dynamic()
        if many == "bounded":
            self.emit(f"if {count} > {size}: raise ValueError(f'{{{count}}} values, at most {size} are allowed')")
        smallest = _smallest(base)
        if many != "array":
            self.emit(f"if {count} * {smallest} > end - p: raise ValueError(f'{{{count}}} values do not fit')")
        if base == "string":
            self.strings(count, target)
            return
        values = self.fresh("v")
        self.emit(f"{target} = {values} = []")
        self.emit(f"add{values} = {values}.append")
        self.emit(f"for _ in range({count}):")
        self.indent += 1
        if isinstance(base, str):
            item = self.fresh("e")
            self.single(base, item)
        elif self.inlined(base):
            item = self.message(base)
        else:
            item = self.fresh("e")
            self.emit(f"{item}, p = {self.function(base)}(buf, view, p, end)")
        self.flush()
        self.emit(f"add{values}({item})")
        self.indent -= 1

    def strings(self, count: str, target: str) -> None:
        """Write the code that reads a list of strings; the block of the last message is compared before decoding."""
        last, values = self.fresh("last"), self.fresh("v")
        self.names.scope[last] = [(-1, b"", [])]
        unpack = self.names.of("length", struct.Struct(self.variant.order + "I").unpack_from, "unpack")
        self.emit(f"known, block, {values} = {last}[0]")
        self.emit(f"if known == {count} and not p & 3 and buf.startswith(block, p):")
        self.emit(f"    {target} = {values}[:]")
        self.emit("    p += len(block)")
        self.emit("else:")
        self.indent += 1
        self.emit(f"{target} = {values} = []")
        self.emit("start = q = p")
        self.emit(f"for _ in range({count}):")
        self.emit("    p = q + (-q & 3)")
        self.emit(f"    n, = {unpack}(buf, p)")
        self.emit("    p += 4")
        self.emit("    q = p + n")
        self.emit("    if q > end or buf[q - 1]: raise ValueError(f'a string of {n} bytes has no end')")
        self.emit(f"    {values}.append(str(buf[p:q - 1], 'utf-8', 'replace') if n else '')")
        self.emit("p = q")
        self.emit("if start & 3 == 0:  # elsewhere the padding differs")
        self.emit(f"    {last}[0] = {count}, buf[start:p], {values}[:]")
        self.indent -= 1


def _smallest(base: Any) -> int:
    """Return the minimum number of bytes of a value, so that impossible counts are rejected at once."""
    if isinstance(base, str):
        return 4 if base in ("string", "wstring") else SIZES[base]
    total = 0
    for _, inner, many, size, _ in base._FIELDS:
        total += _smallest(inner) * (size if many == "array" else 1) if many in ("single", "array") else 4
    return max(total, 1)
