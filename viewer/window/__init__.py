"""The window: frame loop, GLFW and imgui backend, key bindings, style."""
