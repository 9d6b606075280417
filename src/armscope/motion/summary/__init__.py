"""What a finished selection means: one question per file."""
