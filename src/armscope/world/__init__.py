"""Virtual robots with physics that the diagnosis does not see."""
