"""Camera images in the studio."""
