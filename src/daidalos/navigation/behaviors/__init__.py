"""Recovery behaviors: spin, back up, drive on heading and wait."""
