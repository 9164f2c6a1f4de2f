"""A truck with driven rear wheels."""
