"""One file for each kind of sensor; `base` holds their contract."""
