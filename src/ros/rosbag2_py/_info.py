"""Description of a bag."""

from __future__ import annotations

from daidalos.bags.reader import BagReader
from rosbag2_py._format import contents, format_metadata
from rosbag2_py._metadata import BagMetadata, of_bag


class Info:
    """Reader of what bags hold."""

    def read_metadata(self, uri: str, storage_id: str = "") -> BagMetadata:
        """Return what a bag holds; RuntimeError when it cannot be read."""
        with BagReader(uri, storage_id) as bag:
            return of_bag(bag.metadata, bag.size)

    def print_output(self, metadata: BagMetadata, sorting_method: str = "name") -> None:
        """Print what a bag holds."""
        from rosbag2_py._metadata import to_bag

        print(format_metadata(to_bag(metadata), metadata.bag_size, sort=sorting_method))  # noqa: T201

    def print_output_topic_name_only(self, metadata: BagMetadata, sorting_method: str = "name") -> None:
        """Print the names of a bag's topics, without those of services' events."""
        from rosbag2_py._format import ordered
        from rosbag2_py._metadata import to_bag

        for one in ordered(to_bag(metadata).topics, sorting_method):
            if not one.topic.is_service_event:
                print(one.topic.name)  # noqa: T201

    def print_output_verbose(self, uri: str, metadata: BagMetadata, sorting_method: str = "name") -> None:
        """Print what a bag holds, with the size of topics and the calls of services, for which it is read through."""
        with BagReader(uri, metadata.storage_identifier) as bag:
            print(format_metadata(bag.metadata, bag.size, sort=sorting_method, contents=contents(bag)))  # noqa: T201

    def read_metadata_and_output_service_verbose(
        self, uri: str, storage_id: str = "", sorting_method: str = "name"
    ) -> None:
        """Print what a bag holds; see `print_output_verbose`."""
        self.print_output_verbose(uri, self.read_metadata(uri, storage_id), sorting_method)

    def get_sorting_methods(self) -> list[str]:
        """Return by what topics can be ordered."""
        return ["name", "type", "count"]
