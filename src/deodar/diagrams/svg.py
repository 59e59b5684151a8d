"""Writing of a scene as SVG, on a white page or on that of a notebook."""

from __future__ import annotations

from collections.abc import Callable
from html import escape

from deodar.diagrams.scene import Drawing, Shape, TextLine
from deodar.diagrams.text import plain

FONTS = "'DejaVu Sans', Arial, Helvetica, sans-serif"


PAGE = "var(--jp-layout-color0,var(--vscode-editor-background,Canvas))"
"""The colour of the page of a notebook, in JupyterLab, in Visual Studio Code and elsewhere."""

DARK, LIGHT = 0x60, 0xD0
"""Grey below DARK is ink, and a colour whose channels are all above LIGHT is a tint."""


def write(scene: Drawing, width: float | None = None) -> str:
    """Return the picture as SVG on a white page; names are escaped, and text remains text.

    `width` is in points, None: the width of the scene.
    """
    scale = 1.0 if width is None else width / scene.width
    size = f'width="{_n(scene.width * scale)}pt" height="{_n(scene.height * scale)}pt"'
    return _written(scene, size, "background:#ffffff", _plain)


def write_inside(scene: Drawing) -> str:
    """Return the picture as SVG inside a page of a notebook, in the colours of its theme."""
    size = f'width="{_n(scene.width)}pt" height="{_n(scene.height)}pt"'
    return _written(scene, size, f"--page:{PAGE}", _of_theme)


def _written(scene: Drawing, size: str, style: str, paint: Callable[[str, str], str]) -> str:
    out = [
        (
            f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="0 0 {_n(scene.width)}'
            f' {_n(scene.height)}" role="img" font-family="{escape(FONTS)}"'
            f' style="{style};max-width:100%;height:auto">'
        ),
        f"<title>{escape(plain(scene.title))}</title>",
    ]
    for part in scene.parts:
        out.append(
            f'<g class="{escape(part.role)}">'
            + (f"<title>{escape(plain(part.title))}</title>" if part.title else "")
        )
        out += [
            _shape(mark, paint) if isinstance(mark, Shape) else _label(mark, paint) for mark in part.content
        ]
        out.append("</g>")
    return "\n".join([*out, "</svg>", ""])


def _plain(attribute: str, color: str) -> str:
    return f'{attribute}="{color or "none"}"'


def _of_theme(attribute: str, color: str) -> str:
    """Return a colour as ink, tint or page of the theme; other colours are seen on each page."""
    if not color or color == "none":
        return f'{attribute}="none"'
    channels = [int(color[k : k + 2], 16) for k in (1, 3, 5)]
    grey, least = len(set(channels)) == 1, min(channels)
    if least == 255:
        return f'{attribute}="var(--page)"'
    if grey and least < DARK:
        return f'{attribute}="currentColor"'
    if least < LIGHT:
        return f'{attribute}="{color}"'
    opacity = 1 - least / 255  # of a colour that gives this tint on white
    full = "".join(f"{round((c - least) / opacity):02x}" for c in channels)
    return f'{attribute}="{"currentColor" if grey else f"#{full}"}" {attribute}-opacity="{_n(opacity)}"'


def _shape(shape: Shape, paint: Callable[[str, str], str]) -> str:
    path = " ".join(" ".join([move[0], *(_n(float(v)) for v in move[1:])]) for move in shape.path)
    stroke = f' {paint("stroke", shape.stroke)} stroke-width="{_n(shape.width)}"' if shape.stroke else ""
    dash = f' stroke-dasharray="{" ".join(map(_n, shape.dash))}"' if shape.dash else ""
    return f'<path d="{path}" {paint("fill", shape.fill)}{stroke}{dash}/>'


def _label(label: TextLine, paint: Callable[[str, str], str]) -> str:
    style = (' font-weight="bold"' if label.bold else "") + (' font-style="italic"' if label.italic else "")
    anchor = "" if label.anchor == "start" else f' text-anchor="{label.anchor}"'
    text = escape(plain(label.text))
    return (
        f'<text x="{_n(label.x)}" y="{_n(label.y)}" font-size="{_n(label.size)}"'
        f" {paint('fill', label.color)}{anchor}{style}>{text}</text>"
    )


def _n(value: float) -> str:
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
