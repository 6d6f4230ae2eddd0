"""An assignment on paper: sheets to print with each student's own numbers, and the table into which answers are typed.

`sheets` makes the PDFs, and `typed` reads the table; who is judged by it is judged as by a notebook.
"""
