"""What a notebook or a script calls: each command as a function, in the same order of arguments."""
