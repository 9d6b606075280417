"""Real arms: held-out numbers in the reference protocol, models carried over between runs, concealment on real data."""
