"""The source text of a lesson is that of the function which computed the numbers."""

import ast
import inspect
from pathlib import Path

import pytest

from tests import ROOT
from tracer import optics, whitted
from tracer.formulas import shading
from tracer.kernel import entry
from viewer.explain.listing import listing, split_remark, wrapped_code

NAMES = {
    "tracer.optics.transmission": optics.transmission,
    "tracer.optics.refract": optics.refract,
    "tracer.formulas.optics.radicand": optics.radicand,
    "tracer.formulas.shading.phong": shading.phong,
    "tracer.whitted.radiance": whitted.radiance,
    "tracer.kernel.entry.trace_pixels": inspect.unwrap(getattr(entry.trace_pixels, "py_func", entry.trace_pixels)),
}


@pytest.mark.parametrize("name", NAMES)
def test_a_listing_is_the_function(name: str) -> None:
    """But for its docstring it is what the file has at the line of the caption, where the function comes from."""
    found, code = listing(name), NAMES[name].__code__
    file, _, line = found.place.partition(", line ")
    assert Path(code.co_filename) == ROOT / file
    nodes = ast.walk(ast.parse((ROOT / file).read_text("utf-8")))
    (original,) = (node for node in nodes if isinstance(node, ast.FunctionDef) and node.lineno == int(line))
    shown = ast.parse("\n".join(found.lines)).body[0]
    assert isinstance(shown, ast.FunctionDef) and shown.name == original.name == code.co_name
    bodies = [node.body[1:] if ast.get_docstring(node) else node.body for node in (shown, original)]
    assert len({ast.dump(ast.Module(body, [])) for body in bodies}) == 1
    assert ast.dump(shown.args) == ast.dump(original.args)


def test_a_long_docstring_is_left_out() -> None:
    text = "\n".join(listing("tracer.optics.refract").lines)
    assert text.startswith("def refract(") and '"""' not in text
    assert listing("tracer.optics.cosine").lines[1] == '    """c1 = -v.n for unit v."""'


def test_a_long_line_is_wrapped() -> None:
    for name in NAMES:
        for line in listing(name).lines:
            assert wrapped_code(line, len(line) + 1) == [line]
            for most in (24, 31, 57):
                parts = wrapped_code(line, most)
                assert all(len(part) <= most for part in parts)
                assert "".join("".join(parts).split()) == "".join(line.split())
                split = list(split_remark([line], most))
                assert [code + remark for code, remark in split] == parts


def test_a_line_is_broken_where_the_fewest_brackets_are_open() -> None:
    line = "    bend = (n1 - n2) * (n1 + n2) / (n2 * (n1 * c1 + n2 * c2))  # no difference"
    assert wrapped_code(line, 40) == [
        "    bend = (n1 - n2) * (n1 + n2)",
        "        / (n2 * (n1 * c1 + n2 * c2))",
        "        # no difference",
    ]
    assert list(split_remark([line], 40))[2] == ("", "        # no difference")
    assert list(split_remark([line], 99)) == [(line[:-17], line[-17:])]
