"""The studio under the name of the tool that it stands in for."""
