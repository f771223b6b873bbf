"""Shader programs from the files in `shaders/`."""

import re
from collections.abc import Iterable
from importlib.resources import files

import moderngl


def source(name: str) -> str:
    """A shader's text, with its includes inserted."""
    text = (files("shaders") / name).read_text("utf-8")
    return re.sub(r'#include "([^"]+)"', lambda found: source(found.group(1)), text)


def make_program(ctx: moderngl.Context, name: str, defined: Iterable[str] = ()) -> moderngl.Program:
    """The program of `NAME.vert` and `NAME.frag`, with these names defined for their `#ifdef`s."""
    vertex, fragment = (_complete(f"{name}.{stage}", defined) for stage in ("vert", "frag"))
    return ctx.program(vertex_shader=vertex, fragment_shader=fragment)


def _complete(name: str, defined: Iterable[str]) -> str:
    """Insert the definitions after `#version`, which GLSL wants first. Our files begin with a comment."""
    text = source(name)
    version = re.search(r"#version .*\n", text)
    assert version, f"{name} has no #version"
    head = version.group(0) + "".join(f"#define {word}\n" for word in sorted(defined))
    return head + text.replace(version.group(0), "\n", 1)


def put(program: moderngl.Program, **values: object) -> None:
    """Set uniforms. One that the GLSL compiler has removed, since nothing reads it, is skipped."""
    for name, value in values.items():
        if name in program:
            program[name].value = value  # type: ignore[union-attr]
