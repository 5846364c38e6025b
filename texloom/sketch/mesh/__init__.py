"""The texture mesh: a sketch's cells over a texture of any size (Wang et al. 2014, §3.1)."""
