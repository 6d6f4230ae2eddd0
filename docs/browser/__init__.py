"""Python in the reader's browser: where its parts come from, and how they get into the site."""
