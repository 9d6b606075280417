"""Links with encoders of their own, beside their motors."""
