"""The requests of a page, by what they are about; each module registers its own when it is imported."""

from deodar_studio.requests import build_requests as build_requests
from deodar_studio.requests import edit_requests as edit_requests
from deodar_studio.requests import experiment_requests as experiment_requests
from deodar_studio.requests import field_requests as field_requests
from deodar_studio.requests import file_requests as file_requests
from deodar_studio.requests import record_requests as record_requests
from deodar_studio.requests import run_requests as run_requests
from deodar_studio.requests import stream_requests as stream_requests
from deodar_studio.requests import world_requests as world_requests
