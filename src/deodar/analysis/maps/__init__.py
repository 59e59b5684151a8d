"""Maps of regimes: what a field does in each cell of a grid over two parameters."""
