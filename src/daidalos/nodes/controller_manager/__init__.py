"""ros2_control's controller manager and its clients."""

EXECUTABLES = {
    "spawner": "spawner",
    "unspawner": "unspawner",
    # as Foxy and Galactic called them
    "spawner.py": "spawner",
    "unspawner.py": "unspawner",
}
