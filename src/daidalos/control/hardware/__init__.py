"""Hardware that controllers read and command: the contract, and mock hardware."""
