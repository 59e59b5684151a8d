"""What a JupyterHub needs so that a login opens a studio of one's own.

Users, spawner and TLS are those of the hub; deodar and jupyter-server-proxy are installed where its spawner
starts servers.
"""

from pathlib import Path

c = get_config()  # noqa: F821 (JupyterHub defines it)

c.Spawner.default_url = "/deodar/"
# where servers find jupyter_server_config.py: the folder of this file; another spawner has a copy elsewhere
c.Spawner.environment = {"JUPYTER_CONFIG_PATH": str(Path(__file__).resolve().parent)}
