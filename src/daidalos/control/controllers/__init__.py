"""Controllers, one file each, under the names that parameter files know them by."""
