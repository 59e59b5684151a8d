"""Print the titles of the registered kinds; worlds are no part of a document."""

import json

from deodar.kinds.description import descriptions

print(json.dumps([kind.title for kind in descriptions() if kind.room != "worlds"]))
