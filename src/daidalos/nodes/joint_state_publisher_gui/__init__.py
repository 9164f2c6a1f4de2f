"""States of the joints of a described robot, set by hand."""
