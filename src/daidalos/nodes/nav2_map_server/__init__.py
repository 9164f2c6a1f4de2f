"""Server of map files, and programs that save maps."""
