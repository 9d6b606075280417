"""From recordings to a verdict: atlas, selection, refit, certainty, leftover, validation."""
