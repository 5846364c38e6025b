"""Samples and a mesh drawn by our own code, so that everything can be tried and tested without a download."""

from texloom.demo.animal import rabbit
from texloom.demo.samples import SAMPLES, draw
from texloom.demo.write import write_rabbit, write_sample

__all__ = ["SAMPLES", "draw", "rabbit", "write_rabbit", "write_sample"]
