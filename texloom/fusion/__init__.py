"""Several textures over one domain: maps to labels, belts along their borders, and where each texture ends."""
