"""Pictures of the tree of frames."""
