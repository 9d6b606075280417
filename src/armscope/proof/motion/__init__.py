"""The proof on sealed worlds of arms in motion: made, diagnosed as users diagnose, unsealed and scored."""
