"""Server that docks and undocks robots."""

COMPONENTS = {"DockingServer": "_docking_server:DockingServer"}
