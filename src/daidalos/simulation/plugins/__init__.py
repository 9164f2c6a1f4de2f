"""One file for each plugin; `base` holds their contract."""
