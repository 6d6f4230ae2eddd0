"""Mathematics as MathML, made when the site is built; the translation is that of the forms of the exercises."""

from xml.etree import ElementTree

from docutils import nodes

from exercisebook.forms.mathml import convert, formulas, in_html

__all__ = ["convert", "formulas", "in_html", "setup", "width"]

LONG = 50  # letters of a formula that fit onto any sheet


def visit_inline(translator, node):
    translator.body.append(f'<span class="math">{convert(node.astext())}</span>')
    raise nodes.SkipNode


def visit_block(translator, node):
    number = f'<span class="eqno">({node["number"]})</span>' if node.get("number") else ""
    names = f' id="{node["ids"][0]}"' if node["ids"] else ""
    formula = convert(node.astext(), True)
    # paper does not scroll: print.css makes a long formula smaller
    letters = round(width(ElementTree.fromstring(formula)))
    style = f' style="--letters: {letters}"' if letters > LONG else ""
    # it scrolls within itself where it is too wide, so that it must be reached by keyboard
    translator.body.append(f'<div class="math block"{names}{style} tabindex="0">{formula}{number}</div>\n')
    raise nodes.SkipNode


def width(formula):
    r"""Return about how many letters wide a formula is, an element of MathML.

    >>> width(ElementTree.fromstring(convert(r"\frac{K}{T s + 1}")))
    4
    """
    widths = [width(part) for part in formula]
    if formula.tag == "mfrac":
        return max(widths)
    return len((formula.text or "").strip()) + (0.75 if formula.tag in ("msub", "msup") else 1) * sum(widths)


def setup(app):
    app.add_html_math_renderer("mathml", inline_renderers=(visit_inline, None), block_renderers=(visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
