"""The ray tree as a graph for Graphviz: hits are nodes, rays are edges, and shadow rays are dashed."""

from tracer.kernel.nodes import SHADOW
from tracer.printable import printable_lines
from tracer.tree.digits import number_text, rgb_text
from tracer.tree.raytree import RayTree
from tracer.tree.text import end_reason


def write_dot(tree: RayTree) -> str:
    lines = [
        "digraph raytree {",
        '  node [shape=box, style=rounded, fontname="sans-serif"];',
        '  edge [fontname="sans-serif"];',
        "  eye [shape=plaintext];",
    ]
    for i in range(len(tree)):
        row = tree.nodes[i]
        met = tree.object_name(i) or tree.end(i) or ""
        label = f"{met}\n{rgb_text(row['radiance'], row['radiance_error'])}"
        style = "dashed" if row["kind"] == SHADOW else "solid"
        if row["kind"] == SHADOW:
            label = f"{tree.light_name(i)}\n{end_reason(tree, i)}" + (
                f" by {met}" if tree.end(i) == "blocked" and not tree.faces_away(i) else ""
            )
        name = tree.light_label(i) if row["kind"] == SHADOW else tree.label(i)
        parent = "eye" if row["parent"] < 0 else f"n{row['parent']}"
        factor = (
            ""
            if row["parent"] < 0 or row["kind"] == SHADOW
            else f" × {number_text(row['factor'].max(), row['factor_error'])}"
        )
        lines.append(f"  n{i} [label={_quoted(label)}];")
        lines.append(f"  {parent} -> n{i} [label={_quoted(f'{name} {tree.kind(i)}{factor}')}, style={style}];")
    return "\n".join([*lines, "}"]) + "\n"


def _quoted(text: str) -> str:
    escaped = printable_lines(text).replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'
