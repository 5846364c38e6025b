"""Programs to read and run: each draws one picture of the gallery. ``python -m examples`` draws them all."""
