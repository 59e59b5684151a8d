"""From the document to a compiled program: plan (plain data), program (pure functions), executables."""
