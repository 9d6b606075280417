"""Numbers found by scanning."""
