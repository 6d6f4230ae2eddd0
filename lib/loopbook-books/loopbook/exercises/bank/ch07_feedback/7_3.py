"""Python beside the page of exercise 7.3."""

from loopbook.pid import PID

from_panel = PID.from_panel
