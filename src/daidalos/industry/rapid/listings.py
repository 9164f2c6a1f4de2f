"""Listings whose lines a narrow page has broken: where an instruction ends, another one begins on the same line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from daidalos.industry.rapid import flow, tree
from daidalos.industry.rapid.sources import Source


def broken_lines(source: Source, body: Sequence[tree.Statement]) -> Iterator[tuple[int, str]]:
    """Yield the start of calls that end on a line on which another one begins, and what to say about it.

    Of calls that follow each other so, the first is named.
    """
    was_broken = False
    for one, after in pairwise(body):
        is_broken = False
        if isinstance(one, tree.CallStatement) and isinstance(after, tree.CallStatement):
            last = source.place(one.end - 1)[0]
            is_broken = source.place(one.start)[0] < last == source.place(after.start)[0]
            if is_broken and not was_broken:
                text = f"{one.name.text} goes on in line {last}, where '{after.name.text}' begins too"
                yield one.start, f"{text}; one instruction a line"
        was_broken = is_broken
    for one in body:
        for inner in flow.inner_bodies(one):
            yield from broken_lines(source, inner)
