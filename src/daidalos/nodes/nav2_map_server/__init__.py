"""Server of map files, and programs that save maps."""

COMPONENTS = {"MapSaver": "map_saver_server:MapSaver"}
