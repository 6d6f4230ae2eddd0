r"""Labels of the figures, with their mathematics, as HTML: upright and slanted letters, indices, Greek."""

import html
import re

GREEK = dict(zip(
    ("alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "kappa", "lambda", "mu", "nu", "xi", "pi",
     "rho", "sigma", "tau", "phi", "chi", "psi", "omega", "Delta", "Omega", "Theta"),
    "αβγδεζηθκλμνξπρστφχψωΔΩΘ", strict=True))  # fmt: skip
SIGNS = {
    "cdot": "·",
    "times": "×",
    "infty": "∞",
    "leq": "≤",
    "geq": "≥",
    "pm": "±",
    "approx": "≈",
    ",": "\u202f",
    " ": " ",
}
BETWEEN = {"-": "−", "+": "+", "=": "=", "<": "&lt;", ">": "&gt;"}
UPRIGHT = {"mathrm", "text", "mathit", "operatorname"}
TOKEN = re.compile(r"\\([A-Za-z]+|.)|([_^{}'])|([A-Za-z]+)|(.)", re.DOTALL)


def in_html(text):
    r"""Return a label as HTML.

    Raises ValueError for mathematics that has no simple letters.

    >>> in_html(r"$\Delta T_h$ [K], 5 < 6")
    '<i>ΔT</i><sub><i>h</i></sub> [K], 5 &lt; 6'
    >>> in_html(r"$h_{SP} - h$ of $T_{\mathrm{ou}}$")
    '<i>h</i><sub><i>SP</i></sub> − <i>h</i> of <i>T</i><sub>ou</sub>'
    """
    parts = re.split(r"(?<!\\)\$", text)
    done = [mathematics(part) if number % 2 else html.escape(part, quote=False) for number, part in enumerate(parts)]
    return "".join(done)


def mathematics(latex):
    """A formula of one line as HTML."""
    tokens = [token for token in TOKEN.findall(latex) if not token[3].isspace()]
    place = 0

    def group(upright=False):
        """What one token stands for, or all between braces."""
        nonlocal place
        command, sign, word, other = tokens[place]
        place += 1
        if sign == "{":
            inside = ""
            while tokens[place][1] != "}":
                inside += group(upright)
            place += 1
            return inside
        if sign in ("_", "^"):
            tag = "sub" if sign == "_" else "sup"
            return f"<{tag}>{group(upright)}</{tag}>"
        if sign == "'":
            return "′"
        if command in UPRIGHT:
            return group(upright=True)
        if command in ("dot", "bar", "tilde"):
            mark = {"dot": "\u0307", "bar": "\u0304", "tilde": "\u0303"}[command]
            return group(upright).replace("</i>", f"{mark}</i>", 1)
        if command in ("left", "right"):
            return group(upright)
        if command in ("frac", "dfrac"):
            above = group(upright)
            return f"{above}/{group(upright)}"
        if command in GREEK:
            return GREEK[command] if upright else f"<i>{GREEK[command]}</i>"
        if command in SIGNS:
            return SIGNS[command]
        if command:
            raise ValueError(f"{latex!r} has \\{command}: expected letters, indices and simple signs")
        if word:
            return word if upright else f"<i>{word}</i>"
        if other in BETWEEN:
            return f" {BETWEEN[other]} " if place > 1 else BETWEEN[other]
        return html.escape(other, quote=False)

    done = ""
    while place < len(tokens):
        done += group()
    return done.replace("</i><i>", "")


def plain(markup):
    """Return HTML of labels as text, for who hears it."""
    return html.unescape(re.sub(r"<[^>]+>", "", markup))
