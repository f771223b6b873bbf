"""The GPU side: what is drawn with moderngl. Reads `shaders/`; knows scenes and trees, but no panel and no window.

Everything is drawn in the frame of `viewer.base.orbit`: the scene's middle at the origin, its radius 1. So float32
serves scenes of any size.
"""
