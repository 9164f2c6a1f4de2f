"""The bridge for gz's images, which here has both ends in one graph."""
