"""Files and scripts of other tools: importers, exporters, records, and modules in their words."""
