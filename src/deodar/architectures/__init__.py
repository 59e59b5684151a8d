"""Published models as functions that return a `Model`, one file each: `dd.architectures.saliency()`.

Where a module and its function share a name, `deodar.architectures` exports the function; import other names
from the module.
"""

from deodar.architectures.behaviour import behaviour, behaviours, competition, precondition, suppression
from deodar.architectures.cascade import cascade, cascade_paths
from deodar.architectures.change_detection import LENGTH as TRIAL_LENGTH
from deodar.architectures.change_detection import TEST as TEST_WINDOW
from deodar.architectures.change_detection import change_detection, change_trial
from deodar.architectures.color_search import color_search
from deodar.architectures.corridor_plan import START as PLAN_START
from deodar.architectures.corridor_plan import plan
from deodar.architectures.event_selection import event_selection
from deodar.architectures.feature_space import binding, feature_space
from deodar.architectures.follow_the_carrot import Carrot, Ending, follow
from deodar.architectures.looking import looking
from deodar.architectures.pointing import pointing
from deodar.architectures.reference_frame import reference_frame, remapping
from deodar.architectures.saliency import saliency
from deodar.architectures.serial_order import lesson, lesson_end, production_start, serial_order
from deodar.architectures.spa import maze, spa
from deodar.architectures.two_layer_field import Layer, two_layer_field

__all__ = [
    "PLAN_START",
    "TEST_WINDOW",
    "TRIAL_LENGTH",
    "Carrot",
    "Ending",
    "Layer",
    "behaviour",
    "behaviours",
    "binding",
    "cascade",
    "cascade_paths",
    "change_detection",
    "change_trial",
    "color_search",
    "competition",
    "event_selection",
    "feature_space",
    "follow",
    "lesson",
    "lesson_end",
    "looking",
    "maze",
    "plan",
    "pointing",
    "precondition",
    "production_start",
    "reference_frame",
    "remapping",
    "saliency",
    "serial_order",
    "spa",
    "suppression",
    "two_layer_field",
]
