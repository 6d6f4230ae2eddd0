"""Mathematics as MathML, made when the site is built; the translation is that of the forms of the exercises."""

from docutils import nodes

from loopbook.exercises.forms.mathml import convert, formulas, in_html

__all__ = ["convert", "formulas", "in_html", "setup"]


def visit_inline(translator, node):
    translator.body.append(f'<span class="math">{convert(node.astext())}</span>')
    raise nodes.SkipNode


def visit_block(translator, node):
    number = f'<span class="eqno">({node["number"]})</span>' if node.get("number") else ""
    names = f' id="{node["ids"][0]}"' if node["ids"] else ""
    # it scrolls within itself where it is too wide, so that it must be reached by keyboard
    translator.body.append(
        f'<div class="math block"{names} tabindex="0">{convert(node.astext(), True)}{number}</div>\n'
    )
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", inline_renderers=(visit_inline, None), block_renderers=(visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
