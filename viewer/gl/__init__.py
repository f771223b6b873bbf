"""Drawing with OpenGL (moderngl and the GLSL files in `shaders/`). It imports scenes, trees and the session, but no
panel and no window.

Everything is drawn in the frame of `viewer.base.orbit`: the scene's centre is the origin, and its radius is 1. So
float32 is enough for scenes of any size.
"""
