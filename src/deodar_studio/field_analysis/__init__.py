"""What is computed about one field of the open document: its regime and its tuning."""
