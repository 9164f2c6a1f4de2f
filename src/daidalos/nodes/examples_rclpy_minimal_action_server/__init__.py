"""The smallest action servers, which differ in what they do with several goals."""

EXECUTABLES = {"server": "server", "server_not_composable": "server"}
