"""What a recordings table holds, and what looks wrong in it, before anything is fitted."""
