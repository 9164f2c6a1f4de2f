"""Hardware that controllers read and command: the contract, mock hardware, and the simulation's."""
