"""Cells filled from a sample's: maps, kinds, first images, pixels (Wang et al. 2014, §3.2)."""
