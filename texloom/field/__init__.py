"""Direction and scale fields: where texture points on a surface, and how large it is there."""
