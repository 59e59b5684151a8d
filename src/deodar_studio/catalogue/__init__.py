"""What a page offers: examples, templates, and plots of packages."""
