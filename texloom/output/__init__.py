"""From sources to files: images, atlases, vertex colours, previews.

``gather``        values at sites and between them     ``image``           PNG, TIFF, EXR, JPEG; folders of maps
``atlas``         maps baked on UVs                    ``textured``        GLB or OBJ with an atlas
``unwrap``        a fresh atlas                        ``retexture``       a GLB back with new maps, the rest untouched
``uv``            whether UVs can take a texture       ``vertex_colours``  PLY or GLB of the refined mesh
``preview``       pictures without a display           ``sources_file``    sources kept for later
``debug``         where the texture comes from         ``atomic``          files that appear whole or not at all
``sample_uv``     GLB or OBJ on the sample itself      ``blending``        neighbours' maps, edge errors, which show
``edge_picture``  edges in the colour of their error   ``blended_atlas``   the blend baked
"""
