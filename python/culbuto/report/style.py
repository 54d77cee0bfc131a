"""How the figures look: one colour and one mark for each method, on light and on dark.

Figures are drawn in the light colours. Written as SVG, each colour becomes a variable of CSS, to
which the page (or the file itself) gives a value for light and one for dark.
"""

from __future__ import annotations

import io
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Look:
    """A name for people, a colour on light and on dark, and a mark.

    The mark is given twice: as matplotlib's `marker`, and as an SVG `path` within about ±1.
    """

    label: str
    light: str
    dark: str
    marker: str
    path: str


CIRCLE = "M-.9,0a.9,.9 0 1 0 1.8,0a.9,.9 0 1 0 -1.8,0Z"
SQUARE = "M-.8,-.8H.8V.8H-.8Z"
DIAMOND = "M0,-1.1L1.1,0L0,1.1L-1.1,0Z"
UP = "M0,-1L1,.9H-1Z"
DOWN = "M0,1L1,-.9H-1Z"
LEFT = "M-1,0L.9,-1V1Z"
RIGHT = "M1,0L-.9,-1V1Z"
PENTAGON = "M0,-1L.95,-.31L.59,.81H-.59L-.95,-.31Z"
HEXAGON = "M0,-1L.87,-.5V.5L0,1L-.87,.5V-.5Z"
PLUS = "M-.35,-1H.35V-.35H1V.35H.35V1H-.35V.35H-1V-.35H-.35Z"
CROSS = "M-1,-.5L-.5,-1L0,-.5L.5,-1L1,-.5L.5,0L1,.5L.5,1L0,.5L-.5,1L-1,.5L-.5,0Z"
STAR = "M0,-1.3L.31,-.4H1.24L.5,.16L.76,1.05L0,.52L-.76,1.05L-.5,.16L-1.24,-.4H-.31Z"

# Blues and greens for the higher orders, warm colours for the Euler methods; told apart also by
# lightness and by mark, for those who do not see the difference of hue.
METHODS = {
    "closed_form": Look("closed form", "#1b1f24", "#f0f3f6", "*", STAR),
    "contact_step": Look("contact step", "#3d6b21", "#a5d66f", "p", PENTAGON),
    "leapfrog": Look("leapfrog", "#0b69c7", "#58a6ff", "o", CIRCLE),
    "rattle": Look("RATTLE", "#0f8a8a", "#5fd4d0", ">", RIGHT),
    "yoshida4": Look("Yoshida 4", "#2f9fc4", "#8bd5f0", "s", SQUARE),
    "yoshida6": Look("Yoshida 6", "#5a3fc0", "#b3a1ff", "D", DIAMOND),
    "rk4": Look("RK4", "#12805c", "#4cc38a", "^", UP),
    "radau5": Look("Radau IIA 5", "#7a4a1e", "#d9a679", "h", HEXAGON),
    "dop853": Look("DOP853", "#b5327f", "#f58cc4", "P", PLUS),
    "trapezoid": Look("trapezoid", "#737b83", "#a9b1ba", "<", LEFT),
    "semi_implicit_euler": Look("semi-implicit Euler", "#b98300", "#f2c14e", "v", DOWN),
    "explicit_euler": Look("explicit Euler", "#d04e12", "#ff8c5a", "X", CROSS),
}
PEERS = {
    "culbuto": Look("Culbuto", "#3d6b22", "#a5d670", "p", PENTAGON),
    "culbuto-newton": Look("Culbuto, newton", "#3d6b23", "#a5d671", "p", PENTAGON),
    "culbuto-auto": Look("Culbuto, auto", "#3d6b24", "#a5d672", "p", PENTAGON),
    "box2d": Look("Box2D 3", "#8c564b", "#d3a99f", "d", DIAMOND),
    "rapier-f64": Look("Rapier f64", "#4f5b66", "#b9c3cc", "h", PENTAGON),
    "rapier-f32": Look("Rapier f32", "#8a97a3", "#7f8b96", "H", PENTAGON),
    "box2d-2": Look("Box2D 2", "#a5715f", "#c08d7f", "d", DIAMOND),
    "pymunk": Look("pymunk", "#857a00", "#d8cf6a", "8", CIRCLE),
}
INK = Look("", "#24292f", "#e6edf3", "", "")
MUTED = Look("", "#59636e", "#9aa4af", "", "")
LINE = Look("", "#d5dbe1", "#343c46", "", "")
PAPER = Look("", "#fefefe", "#0e1116", "", "")
OTHERS = {**PEERS, "ink": INK, "muted": MUTED, "line": LINE, "paper": PAPER}

RC: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "culbuto",
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8.5,
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.labelsize": 8.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.edgecolor": LINE.light,
    "axes.labelcolor": MUTED.light,
    "axes.titlecolor": INK.light,
    "axes.facecolor": "none",
    "figure.facecolor": "none",
    "text.color": INK.light,
    "grid.color": LINE.light,
    "grid.linewidth": 0.5,
    "xtick.color": LINE.light,
    "ytick.color": LINE.light,
    "xtick.labelcolor": MUTED.light,
    "ytick.labelcolor": MUTED.light,
    "xtick.minor.visible": False,
    "ytick.minor.visible": False,
    "lines.linewidth": 1.3,
    "lines.markersize": 4.2,
    "legend.frameon": False,
}


def css_name(method: str) -> str:
    """Name of the variable that holds a method's colour."""
    return f"--{method.replace('_', '-')}"


def variables(*, dark: bool) -> str:
    """The variables as CSS declarations."""
    looks = {css_name(name): look for name, look in {**METHODS, **OTHERS}.items()}
    pairs = (f"{name}: {look.dark if dark else look.light}" for name, look in looks.items())
    return "; ".join(pairs)


def inline(figure: Figure, name: str, title: str) -> str:
    """A figure as SVG to stand in a page: no prologue, ids of its own, colours as variables."""
    text = _svg(figure)
    text = re.sub(r"^.*?(?=<svg)", "", text, flags=re.DOTALL)
    text = re.sub(r' xmlns(:xlink)?="[^"]*"| version="1.1"', "", text)
    text = re.sub(r'<g id="[^"]*"', "<g", text)
    text = re.sub(r'(\bid="|url\(#|xlink:href="#)', rf"\g<1>{name}-", text).replace("xlink:", "")
    text = re.sub(r' (width|height)="[^"]*pt"', "", text)
    return text.replace("<svg", f'<svg role="img" aria-label="{title}"', 1)


def standalone(figure: Figure, title: str) -> str:
    """A figure as an SVG file with a background of its own, for light and for dark."""
    style = (
        f"<title>{title}</title><style>svg {{ {variables(dark=False)} }} "
        f"@media (prefers-color-scheme: dark) {{ svg {{ {variables(dark=True)} }} }}</style>"
        '<rect width="100%" height="100%" rx="6" style="fill: var(--paper)"/>'
    )
    text = re.sub(r"<!DOCTYPE[^>]*>\n?", "", _svg(figure))
    return re.sub(r"(<svg[^>]*>)", lambda match: match[1] + style, text, count=1)


def _svg(figure: Figure) -> str:
    from matplotlib import rc_context  # noqa: PLC0415 — comes with an extra

    nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
    out = io.StringIO()
    with rc_context(RC):
        figure.savefig(out, format="svg", metadata=nothing)
    text = out.getvalue()
    text = re.sub(r"(\d\.\d\d)\d+", r"\1", text)  # hundredths of a point do
    for name, look in {**METHODS, **OTHERS}.items():
        text = text.replace(look.light, f"var({css_name(name)})")
    text = re.sub(r"font: ([\d.]+)px [^;\"]*", r"font: \1px system-ui, sans-serif", text)
    return text.replace("font-family: 'DejaVu Sans'", "font-family: system-ui, sans-serif")
