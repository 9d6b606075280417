"""Many arms: one diagnosis each, and what only all of them together show."""
