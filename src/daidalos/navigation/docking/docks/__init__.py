"""Types of docks, one class each."""
