"""Writing the description of a bag anew."""

from __future__ import annotations

from rclpy.logging import get_logger

from daidalos.bags.describe import reindex
from rosbag2_py._storage import StorageOptions


class Reindexer:
    """Reindexer, which writes the `metadata.yaml` of bags from their files."""

    def reindex(self, storage_options: StorageOptions) -> None:
        """Write the description of a bag anew; RuntimeError where it has no file that can be read."""
        logger = get_logger("rosbag2_cpp")
        logger.info(f"Beginning reindexing bag in directory: {storage_options.uri}")
        _, faults = reindex(storage_options.uri, storage_options.storage_id)
        for fault in faults:
            logger.warning(fault)
        logger.info("Reindexing complete.")
