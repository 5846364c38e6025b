"""One published system a file: its parts wired in the order of its paper."""
