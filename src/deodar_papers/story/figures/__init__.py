"""The moving pictures of the story."""
