"""Mathematics as people write it: expressions read without `eval`, compared exactly, and shown with their units."""
