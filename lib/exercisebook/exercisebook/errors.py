"""What readers of exercises are told where they ask for what there is not."""

from __future__ import annotations


class ExerciseError(Exception):
    """A wrong use of the exercises, in one sentence."""

    def _render_traceback_(self):
        """Notebooks show the sentence alone: the place in the library's code helps no reader."""
        return [f"{type(self).__name__}: {self}"]
