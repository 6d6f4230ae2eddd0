"""What the theme leaves open for readers who do not see the page, or have no mouse."""


def name_the_level(app, pagename, templatename, context, doctree):
    """Say of the captions at the side, which are headings, of which level they are."""
    tree = context.get("furo_navigation_tree")
    if tree:
        context["furo_navigation_tree"] = tree.replace('role="heading"', 'role="heading" aria-level="2"')


def setup(app):
    """Join Sphinx, behind the theme, which makes the tree."""
    app.connect("html-page-context", name_the_level, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
