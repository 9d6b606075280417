"""False targets: commands under which the real arm reaches the wanted points, by either kind of error model."""
