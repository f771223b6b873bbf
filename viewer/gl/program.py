"""Shader files into programs."""

import re
from collections.abc import Iterable
from importlib.resources import files

import moderngl


def source(name: str) -> str:
    """A shader's text, with what it includes put in."""
    text = (files("shaders") / name).read_text("utf-8")
    return re.sub(r'#include "([^"]+)"', lambda found: source(found.group(1)), text)


def make_program(ctx: moderngl.Context, name: str, defined: Iterable[str] = ()) -> moderngl.Program:
    """The program of `NAME.vert` and `NAME.frag`, with these names defined for its `#ifdef`s."""
    vertex, fragment = (_complete(f"{name}.{stage}", defined) for stage in ("vert", "frag"))
    return ctx.program(vertex_shader=vertex, fragment_shader=fragment)


def _complete(name: str, defined: Iterable[str]) -> str:
    """GLSL wants `#version` before all else, then what is defined; our files begin with what they draw."""
    text = source(name)
    version = re.search(r"#version .*\n", text)
    assert version, f"{name} has no #version"
    head = version.group(0) + "".join(f"#define {word}\n" for word in sorted(defined))
    return head + text.replace(version.group(0), "\n", 1)


def put(program: moderngl.Program, **values: object) -> None:
    """Set uniforms; one that the compiler left out because nothing reads it is passed over."""
    for name, value in values.items():
        if name in program:
            program[name].value = value  # type: ignore[union-attr]
