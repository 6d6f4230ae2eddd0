"""Sequential function charts as readers write them: `notation` reads them, and `running` runs them on a plant.

The two are imported where they are used: whoever only reads a chart needs no plant.
"""
