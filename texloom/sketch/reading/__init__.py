"""Sketches in: files, strokes, pictures and samples become planar graphs of cells."""
