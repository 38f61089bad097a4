"""Pieces of a page in HTML."""

import base64
import html
import io

import matplotlib.pyplot as plt
import numpy as np

# Per inch: twice those of a page.
PIXELS = 144

STYLE = """
body { font: 14px/1.45 system-ui, sans-serif; color: #1d2733; max-width: 62em; margin: 2em auto; padding: 0 1.5em }
h1 { font-size: 1.6em; margin: 0 } h2 { font-size: 1.1em; margin: 2em 0 .5em; border-bottom: 1px solid #d5dbe1 }
p.sub { color: #5d6b79; margin: .2em 0 1.2em } small, td.note { color: #5d6b79 }
.badge { font-size: .55em; padding: .2em .7em; border-radius: 1em; vertical-align: middle; margin-left: .6em }
.good { background: #dff3e4; color: #17682f } .bad { background: #fbe0de; color: #9b1c14 }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(7.9em, 1fr)); gap: .7em }
.card { border: 1px solid #d5dbe1; border-radius: .5em; padding: .5em .8em }
.card b { display: block; font-size: 1.1em; white-space: nowrap } .card span { color: #5d6b79 }
table { border-collapse: collapse; width: 100% } th { text-align: left; color: #5d6b79; font-weight: 600 }
th, td { padding: .2em .8em .2em 0; border-bottom: 1px solid #eceff2; vertical-align: top }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
.key span { margin-right: 1em } .key span::before { content: ""; display: inline-block; width: .8em; height: .8em;
  background: var(--c); margin-right: .35em }
svg, img { max-width: 100%; height: auto } li { margin: .2em 0 }
ul.warnings li::marker { content: "⚠ "; } code { font-size: .95em }
#view canvas { width: 100%; height: 30em; border: 1px solid #d5dbe1; border-radius: .5em; touch-action: none }
#view .controls label { margin-right: 1.5em; white-space: nowrap } #view input[type=range] { vertical-align: middle }
#view .bar { display: flex; align-items: center; gap: .7em; margin: .3em 0 } #view .bar i { flex: 1; height: .8em }
@media screen { #view.drawn .still { display: none } }
@page { size: A4; margin: 1cm }
@media print { #view .live { display: none } * { print-color-adjust: exact }
 body { margin: 0; padding: 0; max-width: none; font-size: 7.5px; line-height: 1.35; columns: 2; column-gap: 2em }
 h1, p.sub { column-span: all } h2 { margin-top: .8em } section p { margin: .3em 0 }
 .cards { margin: .8em 0; break-inside: avoid; grid-template-columns: repeat(4, 1fr); gap: .3em }
 .card { padding: .1em .5em }
 section { break-inside: avoid } th, td { padding-right: .4em } th.number { white-space: normal } }
"""


class Html(str):
    """Text that is HTML already."""


def escape(value):
    """Any value as HTML."""
    return value if isinstance(value, Html) else Html(html.escape(str(value)))


def short(value):
    """A number small or large, in few digits."""
    return "–" if value is None else f"{value:.2g}" if value else "0"


def table(head, rows, numbers=()):
    """A table; the columns in `numbers` are set right."""
    def line(tag, cells):
        kinds = (' class="number"' if i in numbers else "" for i in range(len(cells)))
        return "<tr>" + "".join(f"<{tag}{k}>{escape(c)}</{tag}>" for k, c in zip(kinds, cells)) + "</tr>"

    return "<table>" + line("th", head) + "".join(line("td", row) for row in rows) + "</table>"


def section(title, *content):
    return f"<section><h2>{escape(title)}</h2>{''.join(content)}</section>"


def svg(figure):
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None})
    plt.close(figure)
    return text.getvalue()[text.getvalue().index("<svg") :]


def png(figure, words):
    """A picture of too many pieces for SVG, with `words` for those who don't see it."""
    data = io.BytesIO()
    figure.savefig(data, dpi=PIXELS, pil_kwargs={"optimize": True})
    plt.close(figure)
    text = base64.b64encode(data.getvalue()).decode()
    return f'<img src="data:image/png;base64,{text}" alt="{escape(words)}">'


def axes_of(width, height, layout="constrained", **options):
    figure, axes = plt.subplots(figsize=(width, height), layout=layout, **options)
    for one in np.ravel(axes):
        one.spines[["top", "right"]].set_visible(False)
        one.grid(alpha=0.25, lw=0.5)
        one.set_axisbelow(True)
    return figure, axes
