"""Shows frames: a scene that is drawn with meshcat's geometry, as a page of its own, a still picture, or live in the notebook.

viewer -> scene (what there is) -> drawing, shapes (its geometry) -> picture, page, live
"""
