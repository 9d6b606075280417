"""From recorded samples to even, filtered ones: time stamps, low-pass, derivatives."""
