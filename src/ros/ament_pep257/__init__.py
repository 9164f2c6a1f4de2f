"""The linter of ament that packages call as `ament_pep257`."""
