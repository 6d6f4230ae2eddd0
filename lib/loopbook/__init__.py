"""loopbook: process control by computation, with the books' printed numbers as its proof.

>>> from loopbook import s, t
>>> s, t
(s, t)
"""

from loopbook.expressions import s, t

__all__ = ["s", "t"]
