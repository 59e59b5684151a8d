"""Writing of a scene as SVG."""

from __future__ import annotations

from html import escape

from deodar.diagrams.scene import Drawing, Shape, TextLine
from deodar.diagrams.text import plain

FONTS = "'DejaVu Sans', Arial, Helvetica, sans-serif"


def write(scene: Drawing, width: float | None = None) -> str:
    """Return the picture as SVG; names are escaped, and text remains text.

    `width` is in points, None: the width of the scene.
    """
    w, h, scale = _n(scene.width), _n(scene.height), 1.0 if width is None else width / scene.width
    out = [
        (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{_n(scene.width * scale)}pt"'
            f' height="{_n(scene.height * scale)}pt" viewBox="0 0 {w} {h}" role="img"'
            f' font-family="{escape(FONTS)}" style="background:#ffffff;max-width:100%;height:auto">'
        ),
        f"<title>{escape(plain(scene.title))}</title>",
    ]
    for part in scene.parts:
        out.append(
            f'<g class="{escape(part.role)}">'
            + (f"<title>{escape(plain(part.title))}</title>" if part.title else "")
        )
        out += [_shape(one) if isinstance(one, Shape) else _label(one) for one in part.content]
        out.append("</g>")
    return "\n".join([*out, "</svg>", ""])


def _shape(shape: Shape) -> str:
    path = " ".join(" ".join([move[0], *(_n(float(v)) for v in move[1:])]) for move in shape.path)
    stroke = f' stroke="{shape.stroke}" stroke-width="{_n(shape.width)}"' if shape.stroke else ""
    dash = f' stroke-dasharray="{" ".join(map(_n, shape.dash))}"' if shape.dash else ""
    return f'<path d="{path}" fill="{shape.fill or "none"}"{stroke}{dash}/>'


def _label(label: TextLine) -> str:
    style = (' font-weight="bold"' if label.bold else "") + (' font-style="italic"' if label.italic else "")
    anchor = "" if label.anchor == "start" else f' text-anchor="{label.anchor}"'
    text = escape(plain(label.text))
    return (
        f'<text x="{_n(label.x)}" y="{_n(label.y)}" font-size="{_n(label.size)}"'
        f' fill="{label.color}"{anchor}{style}>{text}</text>'
    )


def _n(value: float) -> str:
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
