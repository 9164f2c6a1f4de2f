"""Menus of interactive markers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from visualization_msgs.msg import InteractiveMarkerFeedback, MenuEntry

if TYPE_CHECKING:
    from .interactive_marker_server import InteractiveMarkerServer

FeedbackCallback = Callable[[InteractiveMarkerFeedback], Any]


@dataclass
class EntryContext:
    """An entry of a menu."""

    title: str = ""
    command: str = ""
    command_type: int = MenuEntry.FEEDBACK
    sub_entries: list[int] = field(default_factory=list)
    visible: bool = True
    check_state: int = 0
    feedback_callback: FeedbackCallback | None = None


class MenuHandler:
    """Menu of interactive markers, whose entries call functions."""

    NO_CHECKBOX = 0
    CHECKED = 1
    UNCHECKED = 2

    def __init__(self) -> None:
        self.top_level_handles_: list[int] = []
        self.entry_contexts_: dict[int, EntryContext] = {}
        self.current_handle_ = 1
        self.managed_markers_: set[str] = set()

    def insert(
        self,
        title: str,
        parent: int | None = None,
        command_type: int = MenuEntry.FEEDBACK,
        command: str = "",
        callback: FeedbackCallback | None = None,
    ) -> int | None:
        """Add an entry and return its handle; None where there is no such parent.

        Parameters
        ----------
        title
            What people read.
        parent
            The entry below which it is; it is at the top if None.
        command_type, command
            What clients do when it is chosen, as `visualization_msgs/MenuEntry` says.
        callback
            Called with an `InteractiveMarkerFeedback` when it is chosen.
        """
        if parent is not None and parent not in self.entry_contexts_:
            return None
        handle = self.doInsert(title, command_type, command, callback)
        siblings = self.top_level_handles_ if parent is None else self.entry_contexts_[parent].sub_entries
        siblings.append(handle)
        return handle

    def doInsert(self, title: str, command_type: int, command: str, feedback_cb: FeedbackCallback | None) -> int:
        """Add an entry that is nowhere in the menu yet, and return its handle."""
        handle = self.current_handle_
        self.current_handle_ += 1
        self.entry_contexts_[handle] = EntryContext(title, command, command_type, feedback_callback=feedback_cb)
        return handle

    def setVisible(self, handle: int, visible: bool) -> bool:
        """Show or hide an entry and those below it; return whether there is such an entry."""
        if handle not in self.entry_contexts_:
            return False
        self.entry_contexts_[handle].visible = visible
        return True

    def setCheckState(self, handle: int, check_state: int) -> bool:
        """Set the check mark of an entry; return whether there is such an entry.

        Parameters
        ----------
        handle
            The entry.
        check_state
            `NO_CHECKBOX`, `CHECKED` or `UNCHECKED`.
        """
        if handle not in self.entry_contexts_:
            return False
        self.entry_contexts_[handle].check_state = check_state
        return True

    def getCheckState(self, handle: int) -> int | None:
        """Return the check mark of an entry, see `setCheckState`; None where there is no such entry."""
        entry = self.entry_contexts_.get(handle)
        return None if entry is None else entry.check_state

    def getTitle(self, handle: int) -> str | None:
        """Return the title of an entry; None where there is no such entry."""
        entry = self.entry_contexts_.get(handle)
        return None if entry is None else entry.title

    def apply(self, server: InteractiveMarkerServer, marker_name: str) -> bool:
        """Set the present menu on a marker; return whether there is such a marker.

        Clients see it after the server's `applyChanges`.
        """
        marker = server.get(marker_name)
        if marker is None:
            self.managed_markers_.discard(marker_name)
            return False
        marker.menu_entries = []
        self.pushMenuEntries(self.top_level_handles_, marker.menu_entries, 0)
        server.insert(
            marker,
            feedback_callback=self.processFeedback,
            feedback_type=InteractiveMarkerFeedback.MENU_SELECT,
        )
        self.managed_markers_.add(marker_name)
        return True

    def reApply(self, server: InteractiveMarkerServer) -> bool:
        """Set the present menu on all markers that have it; return whether they are all there."""
        managed = set(self.managed_markers_)
        return len([name for name in sorted(managed) if self.apply(server, name)]) == len(managed)

    def pushMenuEntries(self, handles_in: Iterable[int], entries_out: list[MenuEntry], parent_handle: int) -> None:
        """Append the messages of visible entries, and of those below them.

        Parameters
        ----------
        handles_in
            The entries.
        entries_out
            Appended to.
        parent_handle
            The entry above them, 0 at the top.
        """
        for handle in handles_in:
            entry = self.entry_contexts_[handle]
            if entry.visible:
                entries_out.append(self.makeEntry(entry, handle, parent_handle))
                self.pushMenuEntries(entry.sub_entries, entries_out, handle)

    def makeEntry(self, context: EntryContext, handle: int, parent_handle: int) -> MenuEntry:
        """Return the message of one entry."""
        mark = {self.CHECKED: "[x] ", self.UNCHECKED: "[ ] "}.get(context.check_state, "")
        return MenuEntry(
            id=handle,
            parent_id=parent_handle,
            title=mark + context.title,
            command=context.command,
            command_type=context.command_type,
        )

    def processFeedback(self, feedback: InteractiveMarkerFeedback) -> None:
        """Call the function of the entry that somebody chose."""
        entry = self.entry_contexts_.get(feedback.menu_entry_id)
        if entry is not None and entry.feedback_callback is not None:
            entry.feedback_callback(feedback)
