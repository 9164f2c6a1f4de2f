"""Conversion of bags: merging, splitting, change of storage or compression, selection of topics."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path

from daidalos.bags.errors import BagError
from daidalos.bags.merged import MergedBags
from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.selection import Selection
from daidalos.bags.storage import FOREVER_NS
from daidalos.bags.writer import BagWriter, WriterOptions


@dataclass(frozen=True)
class Output:
    """Bag to be written.

    Attributes
    ----------
    folder, options
        Where and how.
    selection
        Which topics it gets; all where nothing is asked for.
    start_ns, stop_ns
        First and last time of its messages.
    """

    folder: Path
    options: WriterOptions = field(default_factory=WriterOptions)
    selection: Selection = field(default_factory=Selection)
    start_ns: int = 0
    stop_ns: int = FOREVER_NS


def convert(
    inputs: Sequence[tuple[str | Path, str]],
    outputs: Sequence[Output],
    progress: Callable[[int, int], None] | None = None,
) -> list[str]:
    """Write the messages of input bags to output bags.

    Parameters
    ----------
    inputs
        Bags with their storages (empty to find out); their messages are put in one order by time.
    outputs
        What to write.
    progress
        Called now and then with the number of messages that were read and that there are.

    Returns
    -------
    list of str
        What was broken in the inputs.

    Raises
    ------
    BagError
        When an input cannot be read, or an output is there already.
    """
    for output in outputs:
        if output.folder.exists():
            raise BagError(output.folder, "already exists; a bag is not written over another")
        output.selection.check()
    with ExitStack() as stack:
        bags = stack.enter_context(MergedBags(inputs))
        topics = bags.topics_with_definitions()
        writers = [_begun(stack, output) for output in outputs]
        takers = [_taker(output, writer, topics) for output, writer in zip(outputs, writers, strict=True)]
        total = bags.message_count
        for count, message in enumerate(bags.messages(), 1):
            for take in takers:
                take(message)
            if progress and (count % 1000 == 0 or count == total):
                progress(count, total)
        return bags.notes


def _begun(stack: ExitStack, output: Output) -> BagWriter:
    """Start an output; it is completed when the stack closes, or removed on failure."""
    writer = BagWriter(output.folder, output.options)

    def end(kind: object, error: BaseException | None, trace: object) -> None:
        try:
            writer.close()
        finally:
            if error is not None:
                shutil.rmtree(output.folder, ignore_errors=True)

    stack.push(end)
    return writer


def _taker(output: Output, writer: BagWriter, topics: dict[str, Topic]) -> Callable[[BagMessage], None]:
    selection = output.selection
    wanted = {name: topic for name, topic in topics.items() if _wants(selection, name, topic.type)}
    for topic in wanted.values():
        writer.add_topic(topic)

    def take(message: BagMessage) -> None:
        if message.topic in wanted and output.start_ns <= message.received_ns <= output.stop_ns:
            writer.write(message)

    return take


def _wants(selection: Selection, name: str, type_name: str) -> bool:
    """Return whether a topic is selected; an empty selection includes all topics that are not excluded."""
    if selection.is_empty:
        selection = replace(selection, all_topics=True, all_services=True, hidden=True)
    return selection.wants(name, type_name)
