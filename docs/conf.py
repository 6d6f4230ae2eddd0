"""How Sphinx makes the site."""

import os
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE / "extensions")]

import repository  # noqa: E402 - of docs/extensions/, which has just become a place to import from

project = "loopbook"
author = repository.AUTHORS
project_copyright = repository.COPYRIGHT
version = release = repository.VERSION
language = "en"

extensions = [
    "myst_nb", "stored", "exercise_forms", "mathml", "library", "repository_pages",
    "command_options", "exercise_list", "calls", "ledger_page", "cheat_sheet_page", "front_page", "lesson_directive",
    "permanent", "single_figures", "described", "search_index", "python_in_pages", "reading", "light",
]  # fmt: skip
exclude_patterns = ["lessons", "paper", "**/.ipynb_checkpoints"]

# notebooks: as stored, never run
nb_execution_mode = "off"
nb_ipywidgets_js = {}  # no page holds a widget, and none may fetch one from elsewhere
nb_merge_streams = True
myst_enable_extensions = ["attrs_block", "attrs_inline", "colon_fence", "dollarmath"]
myst_heading_anchors = 4
myst_dmath_double_inline = True

# the library's docstrings
default_role = "py:obj"
smartquotes_action = "D"  # dashes, but no quotes: "PI" in a docstring is what one types
add_module_names = False
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
autodoc_inherit_docstrings = False
autodoc_typehints = "none"
napoleon_numpy_docstring = False
napoleon_use_rtype = False
napoleon_custom_sections = [(name, "params_style") for name in ("Arguments", "Attributes", "Attributes of the class")]

# the look
html_theme = "furo"
html_title = "loopbook"
html_math_renderer = "mathml"
html_static_path = ["_static"]
templates_path = ["_templates"]
html_css_files = ["loopbook.css"]
html_favicon = "_static/favicon.svg"
html_baseurl = os.environ.get(
    "LOOPBOOK_SITE", ""
)  # where the site is going to be, as https://control.example.edu/book/
html_context = {"site": html_baseurl, "licences": repository.LICENCES}  # for previews of links, and the foot
html_copy_source = False
html_show_sourcelink = False
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#005a8c", "color-brand-content": "#005a8c"},
    "dark_css_variables": {"color-brand-primary": "#7cc4f0", "color-brand-content": "#7cc4f0"},
}
