"""Adds the studio to a Jupyter server, at `deodar/` below its address: one studio for each user.

jupyter-server-proxy starts it when it is first opened, and asks for the login of the server. Other users of
the machine cannot use its port, because only the proxy knows the token.
"""

import secrets

c = get_config()  # noqa: F821 (Jupyter defines it)

TOKEN = secrets.token_urlsafe(24)
PORT = "{port}"  # the proxy writes the port that it chose

c.ServerProxy.servers = {
    "deodar": {
        "command": ["deodar", "studio", "--no-browser", "--port", PORT],
        "environment": {"DEODAR_TOKEN": TOKEN},
        # the server has checked host and origin; the studio expects its own, and its cookie
        "request_headers_override": {
            "Host": f"localhost:{PORT}",
            "Origin": f"http://localhost:{PORT}",
            "Cookie": f"deodar_token_{PORT}={TOKEN}",
        },
        "timeout": 60,
        "launcher_entry": {"title": "deodar studio"},
    }
}
