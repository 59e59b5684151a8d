"""Exporters to other tools' files: one folder per tool."""
