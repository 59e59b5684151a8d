"""Who may reach the studio: hosts, origins and the token."""
