"""The server of map files, and the programs that save maps."""
