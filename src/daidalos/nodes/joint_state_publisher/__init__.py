"""States of the joints of a described robot."""
