"""Shader files into programs."""

import re
from importlib.resources import files

import moderngl


def source(name: str) -> str:
    """A shader's text, with what it includes put in."""
    text = (files("shaders") / name).read_text("utf-8")
    return re.sub(r'#include "([^"]+)"', lambda found: source(found.group(1)), text)


def make_program(ctx: moderngl.Context, name: str) -> moderngl.Program:
    """The program of `NAME.vert` and `NAME.frag`."""
    return ctx.program(vertex_shader=_version_first(f"{name}.vert"), fragment_shader=_version_first(f"{name}.frag"))


def _version_first(name: str) -> str:
    """GLSL wants `#version` before all else; our files begin with what they draw."""
    text = source(name)
    version = re.search(r"#version .*\n", text)
    assert version, f"{name} has no #version"
    return version.group(0) + text.replace(version.group(0), "\n", 1)


def put(program: moderngl.Program, **values: object) -> None:
    """Set uniforms; one that the compiler left out because nothing reads it is passed over."""
    for name, value in values.items():
        if name in program:
            program[name].value = value  # type: ignore[union-attr]
