"""The rules that every kind keeps, as `dd.check_kind` and the contract tests judge them."""
