"""`ros2 bag list`."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from dataclasses import dataclass

from daidalos.cli.ros2.extension import Status, Verb


@dataclass(frozen=True)
class _Plugin:
    name: str
    description: str
    type: str
    base_class: str


_BASE = "daidalos.bags"
_PLUGINS = {
    "storage": (
        _Plugin(
            "mcap",
            "Reads and writes MCAP files.",
            f"{_BASE}.mcap_writer.McapWriter",
            f"{_BASE}.storage.StorageWriter",
        ),
        _Plugin(
            "sqlite3",
            "Reads and writes sqlite3 databases.",
            f"{_BASE}.sqlite_writer.SqliteWriter",
            f"{_BASE}.storage.StorageWriter",
        ),
    ),
    "converter": (
        _Plugin(
            "cdr_converter",
            "Messages as ROS 2 sends them.",
            "daidalos.interfaces.codec.Codec",
            "daidalos.interfaces.codec.Codec",
        ),
    ),
    "compression": (
        _Plugin(
            "zstd",
            "Compresses files and messages with Zstandard.",
            f"{_BASE}.compression.compress_file",
            f"{_BASE}.compression",
        ),
    ),
    "decompression": (
        _Plugin(
            "zstd",
            "Decompresses files and messages with Zstandard.",
            f"{_BASE}.compression.decompress_file",
            f"{_BASE}.compression",
        ),
    ),
}


class ListVerb(Verb):
    """Print information about available plugins to the screen."""

    def add_arguments(self, parser: ArgumentParser, cli_name: str) -> None:
        """Declare the verb's arguments."""
        parser.add_argument("plugin_type", choices=list(_PLUGINS), help="Lists available plugins")
        parser.add_argument(
            "-v", "--verbose", action="store_true", help="Output verbose information about the available plugin"
        )

    def main(self, *, args: Namespace) -> Status:
        """Print the plugins of a type."""
        if args.verbose:
            print(f"available {args.plugin_type} plugins are:")
        for plugin in _PLUGINS[args.plugin_type]:
            print(f"name: {plugin.name}" if args.verbose else plugin.name)
            if args.verbose:
                print(f"\t{plugin.description}\n\ttype: {plugin.type}\n\tbase_class: {plugin.base_class}")
        return 0
