"""Foreign tables of recordings: fetched, read by a mapping, converted to recordings.csv."""
